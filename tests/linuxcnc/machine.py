"""The machine behind the controller, and its compensation, made as a user would: measured, diagnosed, written.

The truth has geometric errors (50 µm, 0.2 mrad), backlash in every screw, periodic pitch errors in three and compliant
legs under the platform's weight. All values are random but the compliance. The model is fitted to noisy ball-bar
readings of the seven standard circles and never has access to the truth.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from hexdbb import compensation
from hexdbb.diagnosis import Diagnosis, diagnose
from hexdbb.model import default_effects, new_model
from hexdbb.rig.mechanisms import MECHANISMS, MechanismTable
from hexdbb.rig.truth import TruthFile, random_truth
from hexdbb.samples import Samples
from hexdbb_truth.plans import PACE, discovery_plan
from hexdbb_truth.simulate import simulate

SEED = 5
EFFECTS = ("backlash", "pitch_cyclic", "gravity_sag")
"""Effects of the diagnosis in addition to the geometric errors of the thesis."""


def true_machine(seed: int = SEED) -> TruthFile:
    """Return a random machine."""
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
    """Measure the standard circles on a machine, diagnose it and write its compensation file; return the diagnosis."""
    record = simulate(truth, discovery_plan(), pace=PACE)
    geometry = [effect for effect, is_free in default_effects(record.machine).items() if is_free]
    found = diagnose(Samples.of([record]), new_model(record.machine, [*geometry, *EFFECTS]))
    compensation.write_compensation(compensation.make_compensation(found.model), path)
    return found
