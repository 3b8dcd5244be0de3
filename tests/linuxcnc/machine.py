"""The machine behind the controller, and the compensation a user would make for it: measured, diagnosed, written.

The truth has errors of geometry (50 um, 0.2 mrad), play in every screw, uneven pitch in three and legs that give way
under the platform's weight; its sizes are drawn, none is chosen but the sag's. The model is fitted to what a ball bar
with its noise reads on the seven standard circles; it never sees the truth.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from tests.truth.plans import PACE, discovery_plan
from tests.truth.simulate import simulate

from hexdbb.compensation import make_compensation, write_text
from hexdbb.diagnosis import Diagnosis, diagnose
from hexdbb.model import default_effects, new_model
from hexdbb.rig.mechanisms import MECHANISMS, MechanismTable
from hexdbb.rig.truth import TruthFile, random_truth
from hexdbb.samples import Samples

SEED = 5
EFFECTS = ("backlash", "pitch_cyclic", "gravity_sag")
"""What the diagnosis has beside the thesis' errors of geometry."""


def true_machine(seed: int = SEED) -> TruthFile:
    """Draw a machine."""
    draw = np.random.default_rng([seed, 2])

    def table(kind: str, **values: float) -> MechanismTable:
        return MECHANISMS[kind].model_validate(values)

    play = [table("backlash", slider=k, width_um=round(draw.uniform(4.0, 16.0), 2)) for k in range(1, 7)]
    pitch = [
        table(
            "pitch_cyclic",
            slider=k,
            amplitude_um=round(draw.uniform(2.0, 6.0), 2),
            phase_deg=round(draw.uniform(0.0, 360.0), 1),
            second_amplitude_um=round(draw.uniform(0.5, 2.0), 2),
            second_phase_deg=round(draw.uniform(0.0, 360.0), 1),
        )
        for k in (1, 4, 5)
    ]
    sag = table("gravity_sag", compliance_um_n=0.2)
    return random_truth(seed).model_copy(update={"mechanism": (*play, *pitch, sag)})


def write_compensation(truth: TruthFile, path: Path) -> Diagnosis:
    """Measure the standard circles on a machine, diagnose it, write its compensation file."""
    record = simulate(truth, discovery_plan(), pace=PACE)
    geometry = [effect for effect, is_free in default_effects(record.machine).items() if is_free]
    found = diagnose(Samples.of([record]), new_model(record.machine, [*geometry, *EFFECTS]))
    write_text(make_compensation(found.model).text(), path)
    return found
