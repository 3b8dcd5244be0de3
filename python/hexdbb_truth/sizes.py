"""How large a mechanism must be to show: its signature after all that geometry and set-up can absorb.

Model: the signature of a mechanism is the change it makes to the true readings. What the 33 errors of geometry, the cup
of each mount and the ball can imitate to first order is taken out by least squares; the root mean square of what is
left is the mechanism's size as the data show it, here in multiples of the gauge's noise.
Derivatives are finite differences of the truth's own readings: nothing of the engine is in them.
Units: mm; rad times `ARM_MM` where a parameter is an angle.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from hexdbb.plan import Plan
from hexdbb.rig.geometry import Array
from hexdbb.rig.mechanisms import MechanismTable
from hexdbb.rig.truth import Geometry, Setup, TruthFile
from hexdbb_truth.simulate import Pace, true_readings_mm

STEP_UM = 10.0
"""Central difference to both sides, in um and in urad."""
INVISIBLE_UM = 1e-6
"""Signatures below this are rounding."""
NEGLIGIBLE = 1e-6
"""Singular values this small beside the largest are combinations that the readings cannot see: what stands there is the
third derivative, (step / leg)^2 = 1e-9."""
THINNED = 3
"""Every third sample tells the root mean square as well; at a fourth of 8 Hz the mains' 50 Hz would stand still."""
GEOMETRY_SIZE = 33
CORRECTIONS, NEAR_ENOUGH = 4, 0.002
"""Not every signature is proportional to its size; each round brings the size nearer."""


class AbsorbedError(ValueError):
    """Raised where geometry and set-up absorb a mechanism whatever its size."""


def sized(mechanism: MechanismTable, truth: TruthFile, plan: Plan, pace: Pace, times_noise: float) -> MechanismTable:
    """Return the mechanism in the size whose signature is `times_noise` times the gauge's noise.

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
    AbsorbedError
        The plan cannot see the mechanism at all: geometry and set-up absorb it.
    """
    factor = 1.0
    for _ in range(CORRECTIONS):
        shown_um = signature_um(mechanism.scaled(factor), truth, plan, pace)
        if shown_um < INVISIBLE_UM:
            raise AbsorbedError(f"{mechanism.kind}: geometry and set-up absorb it on this plan")
        correction = times_noise * truth.gauge.noise_um / shown_um
        factor *= correction
        if abs(correction - 1.0) < NEAR_ENOUGH:
            break
    return mechanism.scaled(factor)


@lru_cache(maxsize=1024)
def signature_um(mechanism: MechanismTable, truth: TruthFile, plan: Plan, pace: Pace) -> float:
    """Return the root mean square (um) that a mechanism adds to the readings beyond what geometry and set-up absorb."""
    thin = replace(pace, rate_hz=pace.rate_hz / THINNED, instants_per_sample=pace.instants_per_sample * THINNED)
    faulty = truth.model_copy(update={"mechanism": (*truth.mechanism, mechanism)})
    change_mm = true_readings_mm(faulty, plan, thin) - _readings_mm(truth, plan, thin)
    absorbed = _absorbed(plan, thin)
    left_mm = change_mm - absorbed @ (absorbed.T @ change_mm)
    return float(np.sqrt(np.mean(left_mm**2))) * 1e3


@lru_cache(maxsize=64)
def _readings_mm(truth: TruthFile, plan: Plan, pace: Pace) -> Array:
    return true_readings_mm(truth, plan, pace)


@lru_cache(maxsize=8)
def _absorbed(plan: Plan, pace: Pace) -> Array:
    """Orthonormal basis (n, rank) of what geometry and set-up can do to the readings."""
    nominal = TruthFile()
    columns = [
        true_readings_mm(_moved(nominal, step), plan, pace) - true_readings_mm(_moved(nominal, -step), plan, pace)
        for step in STEP_UM * np.eye(GEOMETRY_SIZE + 3 * len(plan.mounts) + 3)
    ]
    basis, singular, _ = np.linalg.svd(np.stack(columns, axis=1), full_matrices=False)
    seen: Array = basis[:, singular > NEGLIGIBLE * singular[0]]
    return seen


def _moved(truth: TruthFile, change_um: Array) -> TruthFile:
    """Return the machine without its mechanisms, its geometry, cups and ball changed by these (um, urad)."""
    geometry, used = {}, 0
    for name, value in truth.geometry.model_dump().items():
        size = np.size(value)
        geometry[name] = (np.array(value) + change_um[used : used + size].reshape(np.shape(value))).tolist()
        used += size
    mounts = (len(change_um) - used - 3) // 3
    cups = np.zeros((mounts, 3))
    known = truth.setup.cup_error_um[:mounts]
    cups[: len(known)] = np.reshape(known, (-1, 3))
    setup = {
        **truth.setup.model_dump(),
        "cup_error_um": (cups + change_um[used:-3].reshape(mounts, 3)).tolist(),
        "ball_offset_error_um": (np.array(truth.setup.ball_offset_error_um) + change_um[-3:]).tolist(),
    }
    return TruthFile(geometry=Geometry.model_validate(geometry), setup=Setup.model_validate(setup))
