"""Columns that few ask for, computed when they are: the legs' swing, the bar in the platform, counts from a beginning.

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
Pose = tuple[Floats, Floats]

DERIVED = (
    *("swing_angle_rad", "swing_rate_rad_s", "leg_inclination_rad", "bar_angle_rad", "bar_azimuth_rad"),
    "bar_elevation_rad",
    *("time_in_sweep_s", "time_in_circle_s", "time_since_fixing_s", "turned_rad", "wound_rad"),
)
DERIVED_FROM = ("sliders_mm", "velocity_mm_s", "set_up", "time_s", "sweep", "mount", "angle_rad")
"""Columns that these follow from."""
LEGS = 6
STEP_S = 1e-3
"""Half the time over which the swing is differenced: sliders move some 0.1 mm in it, far above rounding, far below
lengths over which the swing bends."""


def derived_columns(
    machine: MachineFile, columns: Mapping[str, NDArray[Any]], set_ups: Sequence[_core.SetUp]
) -> dict[str, NDArray[Any]]:
    """Return the columns `DERIVED`: (n, 6) thrice, (n,) eight times; rad, rad/s, rad, rad, rad, rad, s, s, s, rad, rad.

    Parameters
    ----------
    machine : MachineFile
    columns : mapping of str to ndarray
        Those that are there already.
    set_ups : sequence of SetUp
        That the column ``set_up`` counts.
    """
    sliders_mm, way_mm = columns["sliders_mm"], STEP_S * np.nan_to_num(columns["velocity_mm_s"])
    pose = _pose(machine, sliders_mm)
    reach_mm = _reach_mm(machine, sliders_mm, pose)
    bar_mm = _bar_mm(pose, columns["set_up"], set_ups)
    later, earlier = (
        _swing(machine, _reach_mm(machine, there_mm, _pose(machine, there_mm)))
        for there_mm in (sliders_mm + way_mm, sliders_mm - way_mm)
    )
    return {
        "swing_angle_rad": _swing(machine, reach_mm),
        "swing_rate_rad_s": (later - earlier) / (2.0 * STEP_S),
        "leg_inclination_rad": np.arctan2(np.hypot(reach_mm[0], reach_mm[1]), reach_mm[2]),
        "bar_angle_rad": _bar_angle(bar_mm, pose),
        "bar_azimuth_rad": np.arctan2(bar_mm[:, 1], bar_mm[:, 0]),
        "bar_elevation_rad": np.arctan2(bar_mm[:, 2], np.hypot(bar_mm[:, 0], bar_mm[:, 1])),
        "time_in_sweep_s": columns["time_s"] - _begin_s(columns["time_s"], columns["sweep"]),
        "time_in_circle_s": _in_circle_s(columns["time_s"], columns["set_up"], columns["sweep"]),
        "time_since_fixing_s": _since_fixing_s(columns["time_s"], columns["mount"]),
        "turned_rad": _turned_rad(columns["angle_rad"], columns["sweep"]),
        "wound_rad": _wound_rad(columns["angle_rad"], columns["sweep"], columns["mount"]),
    }


def _pose(machine: MachineFile, sliders_mm: Floats) -> Pose:
    """Return position, shape (n, 3), and rotation, (n, 3, 3), of the nominal machine's platform."""
    position_mm, rotation, _ = forward(machine, sliders_mm)
    return position_mm, rotation


def _bar_mm(pose: Pose, set_up: NDArray[np.integer[Any]], set_ups: Sequence[_core.SetUp]) -> Floats:
    """Return the bar from cup to ball in the base frame, of the nominal machine; shape (n, 3)."""
    position_mm, rotation = pose
    cup_mm = np.array([each.cup_mm for each in set_ups])[set_up]
    ball_mm = np.array([each.ball_offset_mm for each in set_ups])[set_up]
    found: Floats = position_mm - cup_mm + np.einsum("nij,nj->ni", rotation, ball_mm)
    return found


def _bar_angle(bar_mm: Floats, pose: Pose) -> Floats:
    """Return the angle of the bar about the platform's z, shape (n,)."""
    along = np.einsum("nij,ni->nj", pose[1], bar_mm)
    found: Floats = np.arctan2(along[:, 1], along[:, 0])
    return found


def _since_fixing_s(time_s: Floats, mount: NDArray[np.integer[Any]]) -> Floats:
    """Return the time since the first sample of each sample's fixing, shape (n,); nan where all have one.

    With one fixing it would repeat `time_s` under another name.
    """
    is_one = len(mount) == 0 or mount.min() == mount.max()
    return np.full(len(time_s), np.nan) if is_one else time_s - _begin_s(time_s, mount)


def _in_circle_s(time_s: Floats, set_up: NDArray[np.integer[Any]], sweep: NDArray[np.integer[Any]]) -> Floats:
    """Return the time since the first sample of each sample's circle, shape (n,); nan where all have one.

    The same where each circle has one sweep: it would repeat `time_in_sweep_s` under another name.
    """
    circles, sweeps = np.unique(set_up), np.unique(np.column_stack([set_up, sweep]), axis=0)
    if len(circles) <= 1 or len(sweeps) == len(circles):
        return np.full(len(time_s), np.nan)
    return time_s - _begin_s(time_s, set_up)


def _turned_rad(angle_rad: Floats, sweep: NDArray[np.integer[Any]]) -> Floats:
    """Return the angle turned since the first sample of each sweep, with its sign, shape (n,)."""
    begins = np.flatnonzero(np.diff(sweep)) + 1
    ways = (np.unwrap(each) for each in np.split(angle_rad, begins))
    return np.concatenate([each - each[:1] for each in ways])


def _wound_rad(angle_rad: Floats, sweep: NDArray[np.integer[Any]], mount: NDArray[np.integer[Any]]) -> Floats:
    """Return the angle turned since the first sample of each fixing, with its sign, shape (n,).

    Nan where each has one sweep: it would repeat `turned_rad` under another name. From sweep to sweep the platform goes
    the shorter way round.
    """
    if len(np.unique(np.column_stack([mount, sweep]), axis=0)) == len(np.unique(mount)):
        return np.full(len(angle_rad), np.nan)
    found = np.empty(len(angle_rad))
    for each in np.unique(mount):
        rows = np.flatnonzero(mount == each)
        way = np.unwrap(angle_rad[rows])
        found[rows] = way - way[0]
    return found


def _begin_s(time_s: Floats, part: NDArray[np.integer[Any]]) -> Floats:
    """Return the time at which each sample's part, a sweep, a circle or a fixing, begins; shape (n,)."""
    member = np.unique(part, return_inverse=True)[1].ravel()
    begin = np.full(int(member.max()) + 1, np.inf)
    np.minimum.at(begin, member, time_s)
    found: Floats = begin[member]
    return found


def _reach_mm(machine: MachineFile, sliders_mm: Floats, pose: Pose) -> Floats:
    """Return each leg from its slider's joint to the platform's, shape (3, n, 6)."""
    position_mm, rotation = pose
    nominal = engine_machine(machine)
    joints = np.column_stack([_core.platform_joint(nominal, leg // 2) for leg in range(LEGS)])
    vertices = np.column_stack([_core.guideway_vertex(nominal, leg // 2) for leg in range(LEGS)])
    along = np.column_stack([_core.guideway_direction(nominal, leg // 2) for leg in range(LEGS)])
    found = np.empty((3, *sliders_mm.shape))
    for axis in range(3):
        foot_mm = vertices[axis] + sliders_mm * along[axis]
        found[axis] = position_mm[:, [axis]] + rotation[:, axis, :] @ joints - foot_mm
    return found


def _swing(machine: MachineFile, reach_mm: Floats) -> Floats:
    """Return the swing of each leg about its guideway, shape (n, 6)."""
    nominal = engine_machine(machine)
    axes = np.stack([_core.guideway_axes(nominal, leg // 2) for leg in range(LEGS)], axis=-1)
    across, up = (sum(reach_mm[axis] * axes[axis, which] for axis in range(3)) for which in (2, 0))
    found: Floats = np.arctan2(across, up)
    return found
