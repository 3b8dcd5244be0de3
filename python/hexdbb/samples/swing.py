"""Columns that few ask for, computed when they are: the legs' swing, the bar in the platform, time within a sweep.

The swing of a leg is the angle about its guideway at which it stands, from the guideway's own axes; its rate is the
central difference along the slider's smoothed velocity, so that the encoders' steps do not show in it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.kinematics import engine_machine, forward
from hexdbb.machine import MachineFile

Floats = NDArray[np.float64]

DERIVED = ("swing_angle_rad", "swing_rate_rad_s", "leg_inclination_rad", "bar_angle_rad", "time_in_sweep_s")
DERIVED_FROM = ("sliders_mm", "velocity_mm_s", "set_up", "time_s", "sweep")
"""Columns that these follow from."""
STEP_S = 1e-3
"""Half the time over which the swing is differenced: sliders move some 0.1 mm in it, far above rounding, far below
lengths over which the swing bends."""


def derived_columns(
    machine: MachineFile, columns: Mapping[str, NDArray[Any]], set_ups: Sequence[_core.SetUp]
) -> dict[str, NDArray[Any]]:
    """Return the columns `DERIVED`: (n, 6) thrice, (n,) twice; rad, rad/s, rad, rad and s.

    Parameters
    ----------
    machine : MachineFile
    columns : mapping of str to ndarray
        Those that are there already.
    set_ups : sequence of SetUp
        That the column ``set_up`` counts.
    """
    sliders_mm, way_mm = columns["sliders_mm"], STEP_S * np.nan_to_num(columns["velocity_mm_s"])
    (swing, inclination), (later, _), (earlier, _) = (
        _stance(machine, sliders_mm + way) for way in (np.zeros(1), way_mm, -way_mm)
    )
    return {
        "swing_angle_rad": swing,
        "swing_rate_rad_s": (later - earlier) / (2.0 * STEP_S),
        "leg_inclination_rad": inclination,
        "bar_angle_rad": _bar_angle(machine, sliders_mm, columns["set_up"], set_ups),
        "time_in_sweep_s": columns["time_s"] - _begin_s(columns["time_s"], columns["sweep"]),
    }


def _bar_angle(
    machine: MachineFile, sliders_mm: Floats, set_up: NDArray[np.integer[Any]], set_ups: Sequence[_core.SetUp]
) -> Floats:
    """Return the angle of the bar about the platform's z, of the nominal machine; shape (n,)."""
    position_mm, rotation, _ = forward(machine, sliders_mm)
    cup_mm = np.array([each.cup_mm for each in set_ups])[set_up]
    ball_mm = np.array([each.ball_offset_mm for each in set_ups])[set_up]
    bar_mm = np.einsum("nij,ni->nj", rotation, position_mm - cup_mm) + ball_mm
    found: Floats = np.arctan2(bar_mm[:, 1], bar_mm[:, 0])
    return found


def _begin_s(time_s: Floats, sweep: NDArray[np.integer[Any]]) -> Floats:
    """Return the time at which each sample's sweep begins, shape (n,)."""
    member = np.unique(sweep, return_inverse=True)[1].ravel()
    begin = np.full(int(member.max()) + 1, np.inf)
    np.minimum.at(begin, member, time_s)
    found: Floats = begin[member]
    return found


def _stance(machine: MachineFile, sliders_mm: Floats) -> tuple[Floats, Floats]:
    """Return the swing of each leg about its guideway, and its inclination to the vertical, each shape (n, 6)."""
    position_mm, rotation, _ = forward(machine, sliders_mm)
    nominal = engine_machine(machine)
    swing, inclination = np.empty(sliders_mm.shape), np.empty(sliders_mm.shape)
    for leg in range(6):
        guideway = leg // 2
        axes = _core.guideway_axes(nominal, guideway)
        along = _core.guideway_direction(nominal, guideway)
        foot = _core.guideway_vertex(nominal, guideway) + sliders_mm[:, [leg]] * along
        reach = position_mm + rotation @ _core.platform_joint(nominal, guideway) - foot
        swing[:, leg] = np.arctan2(reach @ axes[:, 2], reach @ axes[:, 0])
        inclination[:, leg] = np.arctan2(np.hypot(reach[:, 0], reach[:, 1]), reach[:, 2])
    return swing, inclination
