"""Limits of a motion: what a path allows along itself, and the check of every row of a table.

Model: sliders s(u) along a path u(t) move with s' = s_u u', s'' = s_u u'' + s_uu u'². The largest |s_u| and |s_uu| of
the path, found by probing it, turn the sliders' limits into limits of u. The finished table is checked once more, by
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
"""Points at which a path is probed."""
PROBE_DEG = 1.0
"""Angle between two probes where the path is one turn."""
TRAVEL_SHARES = (0.4, 0.25, 0.15, 0.1)
"""Share of the sliders' limits used on the way, the first with which every row keeps them; the rest is for corrections:
those of the position loop, and of a compensation, which must follow every turn of a screw."""

Made = TypeVar("Made")
Where = Callable[[int], str]
"""Names a row of a table for an error message."""


class TooFastError(InputError):
    """A slider would exceed a limit; `row` is where."""

    def __init__(self, message: str, row: int) -> None:
        super().__init__(message)
        self.row = row


def check_reach(status: NDArray[np.integer], where: Where) -> None:
    """Raise `InputError` at the first row the inverse kinematics does not accept; `status` is (n,)."""
    failed = np.flatnonzero(status)
    if failed.size:
        row = int(failed[0])
        raise InputError(f"{where(row)}: {status_name(int(status[row]))} (expected every pose within reach and travel)")


def check_motion(sliders_mm: Array, cycle_s: float, limits: Limits, where: Where) -> None:
    """Raise `TooFastError` where a slider would exceed its velocity, acceleration or jerk; `sliders_mm` is (n, 6)."""
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
                f"{where(row)}: {name} of slider {slider + 1}: {value:.4g} {unit} (expected at most {bound:g} {unit})",
                row,
            )


def slow_enough(shares: Sequence[float], make: Callable[[float], Made]) -> Made:
    """Give what `make` makes with the largest of some shares that keeps every limit.

    Raises
    ------
    InputError
        What `make` raises with the smallest one, or whatever has nothing to do with speed.
    """
    for share in shares[:-1]:
        with suppress(TooFastError):
            return make(share)
    return make(shares[-1])


def path_limits(path: PosePath, machine: MachineFile, share: float, where: Where) -> PathLimits:
    """Limits along a path that keep every slider within a share of its own limits.

    Raises
    ------
    InputError
        A pose on the path cannot be reached.
    """
    limits = machine.can_setup.limits
    u_mm = np.linspace(0.0, path.length_mm, PROBES)
    sliders_mm, status = inverse(machine, *path.poses(u_mm))
    check_reach(status, where)
    step_mm = path.length_mm / (PROBES - 1)
    slope = float(np.abs(np.diff(sliders_mm, axis=0)).max()) / step_mm
    bend = float(np.abs(np.diff(sliders_mm, n=2, axis=0)).max()) / step_mm**2
    tiny = 1e-9
    velocity = min(
        share * limits.velocity_mm_s / max(slope, tiny),
        float(np.sqrt(share * limits.acceleration_mm_s2 / 2.0 / max(bend, tiny))),
    )
    return PathLimits(
        velocity,
        share * limits.acceleration_mm_s2 / 2.0 / max(slope, tiny),
        share * limits.jerk_mm_s3 / 2.0 / max(slope, tiny),
    )
