"""Stiction of a slider that reverses before the first reading of a circle, on a simulated machine stepped in time."""

from __future__ import annotations

import numpy as np
import pytest
from tests.fleet.made import plan_of, set_up

from hexdbb.diagnosis import diagnose
from hexdbb.model import Choice, new_model
from hexdbb.rig.mechanisms import MECHANISMS
from hexdbb.rig.truth import random_truth
from hexdbb.samples import Samples
from hexdbb_truth.simulate import Pace, simulate

NOISE_MM = 5e-4
SLIDERS = (3, 6)
"""Those that reverse along the last 45 degrees before the first reading of some circle of the plan."""


@pytest.mark.parametrize("overshoot_deg", [45.0, 180.0])
@pytest.mark.parametrize("slider", SLIDERS)
def test_its_decay_is_explained_from_the_first_reading_on(slider: int, overshoot_deg: float) -> None:
    """Without the reversal before it, 0.72 µm of 200 µm are left."""
    plan = plan_of("standard").model_copy(update={"overshoot_deg": overshoot_deg, "laps": 1})
    stiction = MECHANISMS["reversal_spike"].model_validate({"slider": slider, "breakaway_um": 200.0, "decay_s": 0.4})
    truth = random_truth(1).model_copy(update={"setup": set_up(1), "mechanism": (stiction,)})
    samples = Samples.of([simulate(truth, plan, seed=1, pace=Pace(11.4, 10, 2.0))])
    model = new_model(samples.machine).with_effect(Choice("reversal_spike", str(slider)))
    left_mm = diagnose(samples, model, check_held_out=False).residual_mm
    assert np.sqrt(np.mean(left_mm**2)) < 1.1 * NOISE_MM
