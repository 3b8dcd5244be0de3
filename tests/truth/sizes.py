"""How large a mechanism must be to show: its signature after all that geometry and set-up can absorb.

Model: the signature of a mechanism is the change it makes to the true readings. What the 33 errors of geometry, the cup
of each mount and the ball can imitate to first order is taken out by least squares; the root mean square of what is
left is the mechanism's size as the data show it, here in multiples of the gauge's noise.
Derivatives are finite differences of the truth's own readings: nothing of the engine is in them.
Units: mm; rad times `ARM_MM` where a parameter is an angle.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache

import numpy as np
from tests.truth.simulate import Pace, true_readings_mm

from hexdbb.plan import Plan
from hexdbb.rig.geometry import Array
from hexdbb.rig.mechanisms import MechanismTable
from hexdbb.rig.truth import Geometry, Setup, TruthFile

STEP_UM = 10.0
"""Central difference to both sides, in um and in urad."""
INVISIBLE_UM = 1e-6
"""Signatures below this are rounding."""
NEGLIGIBLE = 1e-6
"""Singular values this small beside the largest are combinations that the readings cannot see: what stands there is the
third derivative, (step / leg)^2 = 1e-9."""
THINNED = 3
"""Every third sample tells the root mean square as well; at a fourth of 8 Hz the mains' 50 Hz would stand still."""
CORRECTIONS = 3
"""Not every signature is proportional to its size; each round brings the size nearer."""


def sized(mechanism: MechanismTable, truth: TruthFile, plan: Plan, pace: Pace, times_noise: float) -> MechanismTable:
    """Give the mechanism in the size whose signature is `times_noise` times the gauge's noise.

    Parameters
    ----------
    mechanism : MechanismTable
        Of some size: its other keys (element, phase, time constant) stay.
    truth : TruthFile
        The machine that it acts in. A late gauge and a wrong scale show only where readings are not zero.
    plan : Plan
    pace : Pace
        What is driven, and how it is sampled.
    times_noise : float
        Root mean square of what is left of the signature, over the noise's standard deviation.

    Raises
    ------
    ValueError
        The plan cannot see the mechanism at all: geometry and set-up absorb it.
    """
    factor = 1.0
    for _ in range(CORRECTIONS):
        shown_um = signature_um(mechanism.scaled(factor), truth, plan, pace)
        if shown_um < INVISIBLE_UM:
            raise ValueError(f"{mechanism.kind}: geometry and set-up absorb it on this plan")
        factor *= times_noise * truth.gauge.noise_um / shown_um
    return mechanism.scaled(factor)


def signature_um(mechanism: MechanismTable, truth: TruthFile, plan: Plan, pace: Pace) -> float:
    """Give the root mean square (um) that a mechanism adds to the readings beyond what geometry and set-up absorb."""
    thin = replace(pace, rate_hz=pace.rate_hz / THINNED, instants_per_sample=pace.instants_per_sample * THINNED)
    faulty = truth.model_copy(update={"mechanism": (*truth.mechanism, mechanism)})
    change = true_readings_mm(faulty, plan, thin) - _readings_mm(truth, plan, thin)
    absorbed = _absorbing(plan, thin)
    left = change - absorbed @ (absorbed.T @ change)
    return float(np.sqrt(np.mean(left**2))) * 1e3


@lru_cache(maxsize=64)
def _readings_mm(truth: TruthFile, plan: Plan, pace: Pace) -> Array:
    return true_readings_mm(truth, plan, pace)


@lru_cache(maxsize=8)
def _absorbing(plan: Plan, pace: Pace) -> Array:
    """Orthonormal basis (n, rank) of the signatures of geometry and set-up."""
    columns = [
        true_readings_mm(more, plan, pace) - true_readings_mm(less, plan, pace)
        for more, less in zip(_stepped(len(plan.mounts), STEP_UM), _stepped(len(plan.mounts), -STEP_UM), strict=True)
    ]
    basis, singular, _ = np.linalg.svd(np.stack(columns, axis=1), full_matrices=False)
    seen: Array = basis[:, singular > NEGLIGIBLE * singular[0]]
    return seen


def _stepped(mounts: int, step_um: float) -> Iterator[TruthFile]:
    """Give truths that differ from the nominal machine in one parameter each."""
    for name, value in Geometry().model_dump().items():
        for changed in _one_at_a_time(np.array(value), step_um):
            yield TruthFile(geometry=Geometry.model_validate({name: changed.tolist()}))
    for changed in _one_at_a_time(np.zeros((mounts, 3)), step_um):
        yield TruthFile(setup=Setup.model_validate({"cup_error_um": changed.tolist()}))
    for changed in _one_at_a_time(np.zeros(3), step_um):
        yield TruthFile(setup=Setup.model_validate({"ball_offset_error_um": changed.tolist()}))


def _one_at_a_time(value: Array, step_um: float) -> Iterator[Array]:
    for index in np.ndindex(*value.shape):
        changed = value.copy()
        changed[index] += step_um
        yield changed
