"""Limits of motion: limits along a path that follow from those of the sliders, and the check of every row of a table.

Model: sliders s(u) along a path u(t) move with s' = s_u u', s'' = s_u u'' + s_uu u'². The largest |s_u| and |s_uu|,
found by sampling the path, convert the sliders' limits into limits of u. The finished table is checked again, by
differences.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.kinematics import inverse, status_name
from hexdbb.machine import Limits, MachineFile
from hexdbb.trajectory.poses import Array, PosePath
from hexdbb.trajectory.time_law import PathLimits

PROBES = 361
"""Points at which a path is sampled to find its largest slopes: one per degree of a turn. What lies between two samples
is caught by `check_motion`, which checks every row."""
PROBE_DEG = 1.0
"""Angle between two samples where the path is one turn: 360 / (PROBES - 1)."""
LIMIT_FRACTIONS = (0.4, 0.25, 0.15, 0.1)
"""Fractions of the sliders' limits that moves between captures may use; the first is taken with which every row is
within the limits. The remainder is left to corrections: of the position loop, and of a compensation, which follows
every turn of a screw."""

Made = TypeVar("Made")
SLOPE_MIN = 1e-9
"""Limits slopes from below (mm per mm, 1/mm), so that a path along which no slider moves does not divide by zero; a
path that moves a slider has slopes above 1e-3."""

RowName = Callable[[int], str]
"""Returns the name of a row of a table for an error message."""


class TooFastError(InputError):
    """Raised where a slider would exceed a limit; `row` is the row of the table, from 0."""

    def __init__(self, message: str, row: int) -> None:
        super().__init__(message)
        self.row = row


def check_reach(status: NDArray[np.integer], row_name: RowName) -> None:
    """Check the status (n,) of inverse kinematics; raise `InputError` for the first row that has no solution."""
    failed = np.flatnonzero(status)
    if failed.size:
        row = int(failed[0])
        raise InputError(
            f"{row_name(row)}: {status_name(int(status[row]))} (expected every pose within reach and travel)"
        )


def check_motion(sliders_mm: Array, cycle_s: float, limits: Limits, row_name: RowName) -> None:
    """Check the velocity, acceleration and jerk of slider targets by differences.

    Parameters
    ----------
    sliders_mm : ndarray, shape (n, 6)
        Targets, mm, one row per cycle.
    cycle_s : float
        Time between two rows, s.
    limits : Limits
    row_name : callable
        Names a row in errors.

    Raises
    ------
    TooFastError
        Names the first row that exceeds a limit, the slider, the value and the limit.
    """
    rate = sliders_mm
    bounds = (
        ("velocity", "mm/s", limits.velocity_mm_s),
        ("acceleration", "mm/s²", limits.acceleration_mm_s2),
        ("jerk", "mm/s³", limits.jerk_mm_s3),
    )
    for name, unit, bound in bounds:
        rate = np.diff(rate, axis=0) / cycle_s
        over = np.abs(rate) > bound
        if over.any():
            row, slider = (int(i) for i in np.argwhere(over)[0])
            value = abs(float(rate[row, slider]))
            raise TooFastError(
                f"{row_name(row)}: {name} of slider {slider + 1}: {value:.4g} {unit}"
                f" (expected at most {bound:g} {unit})",
                row,
            )


def fastest_within_limits(fractions: Sequence[float], make: Callable[[float], Made]) -> Made:
    """Return the result of `make` for the first of the fractions, largest first, that keeps every limit.

    Raises
    ------
    InputError
        Raised by `make` for the smallest fraction, or for a reason other than speed.
    """
    for fraction in fractions[:-1]:
        with suppress(TooFastError):
            return make(fraction)
    return make(fractions[-1])


def path_limits(path: PosePath, machine: MachineFile, limit_fraction: float, row_name: RowName) -> PathLimits:
    """Compute limits along a path that keep every slider within a fraction of its own limits.

    Each of the two terms of the acceleration, and of the jerk, gets one half of its limit.

    Parameters
    ----------
    path : PosePath
    machine : MachineFile
        Its motion limits hold.
    limit_fraction : float
        Fraction of the limits to use, 0 to 1.
    row_name : callable
        Names a sample of the path in errors.

    Returns
    -------
    PathLimits

    Raises
    ------
    InputError
        A pose on the path cannot be reached.
    """
    limits = machine.can_setup.limits
    u_mm = np.linspace(0.0, path.length_mm, PROBES)
    sliders_mm, status = inverse(machine, *path.poses(u_mm))
    check_reach(status, row_name)
    step_mm = path.length_mm / (PROBES - 1)
    slope = float(np.abs(np.diff(sliders_mm, axis=0)).max()) / step_mm
    bend = float(np.abs(np.diff(sliders_mm, n=2, axis=0)).max()) / step_mm**2
    velocity = min(
        limit_fraction * limits.velocity_mm_s / max(slope, SLOPE_MIN),
        float(np.sqrt(limit_fraction * limits.acceleration_mm_s2 / 2.0 / max(bend, SLOPE_MIN))),
    )
    return PathLimits(
        velocity,
        limit_fraction * limits.acceleration_mm_s2 / 2.0 / max(slope, SLOPE_MIN),
        limit_fraction * limits.jerk_mm_s3 / 2.0 / max(slope, SLOPE_MIN),
    )
