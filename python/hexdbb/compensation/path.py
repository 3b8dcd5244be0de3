"""Slider targets along a path of poses, as a controller would compute them from pose to pose (`compensation.hpp`).

Assumption: the poses are in order of motion. The direction of travel of each slider follows from the poses so far;
`hexdbb.compensation.targets` knows the motion to come and changes over earlier.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.kinematics import status_name

Floats = NDArray[np.float64]

STEP_WITHOUT_TIMES_S = 1e6
"""Time step between the poses of a path without times, s. The order of the poses determines directions of travel; at
this step a slider that crosses its whole travel moves below 1 µm/s, so that speed-dependent corrections vanish."""


@dataclass(frozen=True)
class PathTargets:
    """Slider targets along a path."""

    sliders_mm: Floats
    """Target slider coordinates, shape (n, 6), mm."""
    correction_mm: Floats
    """Targets minus nominal slider coordinates, shape (n, 6), mm."""


def path_targets(
    data: _core.CompensationData,
    position_mm: ArrayLike,
    rpy_rad: ArrayLike,
    *,
    time_s: ArrayLike | None = None,
    temperature_c: float = math.nan,
    name: str = "the path",
) -> PathTargets:
    """Compute compensated slider targets along a path.

    Parameters
    ----------
    data : CompensationData
    position_mm : array_like, shape (n, 3)
        Platform positions in order of motion, mm.
    rpy_rad : array_like, shape (n, 3) or (3,)
        Roll, pitch, yaw of each pose or of all, rad.
    time_s : array_like, shape (n,), optional
        Time of each pose, s; velocities follow from it. Without it only directions of travel are used.
    temperature_c : float
        Measured temperature, °C; nan where there is none.
    name : str
        Name of the path in error messages.

    Returns
    -------
    PathTargets

    Raises
    ------
    InputError
        Naming the first pose without targets, the slider and the reason.
    """
    position = np.ascontiguousarray(position_mm, dtype=np.float64)
    rpy = np.ascontiguousarray(np.broadcast_to(np.asarray(rpy_rad, dtype=np.float64), position.shape))
    count = len(position)
    times = STEP_WITHOUT_TIMES_S * np.arange(count) if time_s is None else np.asarray(time_s, dtype=np.float64)
    compensator = _core.Compensator(data, name)
    sliders, correction, status, slider = compensator.sliders_along(
        position, rpy, times, np.full(count, temperature_c, dtype=np.float64)
    )
    failed = np.flatnonzero(status)
    if failed.size:
        row = int(failed[0])
        raise InputError(f"{name}: row {row + 1}: slider {slider[row] + 1}: {status_name(int(status[row]))}")
    return PathTargets(sliders, correction)
