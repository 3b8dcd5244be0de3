"""Angles in the joints of the nominal machine and how fast they turn, from the nominal poses.

At the slider's end the leg makes an angle with its guideway (`slider_joint_angle`) and swings about it
(`swing_angle`); at the platform's end it makes one with the platform's normal (`platform_joint_angle`). Rates are
central differences along each sweep.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.kinematics import engine_machine, forward
from hexdbb.machine import MachineFile

Floats = NDArray[np.float64]


def joint_state(
    machine: MachineFile, sliders_mm: Floats, time_s: Floats, sweep: NDArray[np.integer], polar_rad: Floats
) -> dict[str, Floats]:
    """Return joint angles (rad) and rates (rad/s), (n, 6) each, and the bar's angle in the platform, (n,).

    Parameters
    ----------
    machine : MachineFile
    sliders_mm : ndarray, shape (n, 6)
    time_s : ndarray, shape (n,)
    sweep : ndarray of int, shape (n,)
    polar_rad : ndarray, shape (n,)
        Commanded polar angle.
    """
    position_mm, rotation, _ = forward(machine, sliders_mm)
    nominal = engine_machine(machine)
    angle, swing, tilt = (np.empty(sliders_mm.shape) for _ in range(3))
    for leg in range(6):
        guideway = leg // 2
        along = _core.guideway_direction(guideway)
        axes = _core.guideway_axes(guideway)
        foot = _core.guideway_vertex(nominal, guideway) + sliders_mm[:, [leg]] * along
        joint = position_mm + rotation @ _core.platform_joint(nominal, guideway)
        unit = (joint - foot) / np.linalg.norm(joint - foot, axis=1, keepdims=True)
        angle[:, leg] = np.arccos(np.clip(unit @ along, -1.0, 1.0))
        swing[:, leg] = np.arctan2(unit @ axes[:, 2], unit @ axes[:, 0])
        tilt[:, leg] = np.arccos(np.clip(np.einsum("ni,ni->n", unit, rotation[:, :, 2]), -1.0, 1.0))
    yaw = np.arctan2(rotation[:, 1, 0], rotation[:, 0, 0])
    return {
        "slider_joint_angle": angle,
        "slider_joint_rate": _rates(angle, time_s, sweep),
        "swing_angle": swing,
        "swing_rate": _rates(swing, time_s, sweep),
        "platform_joint_angle": tilt,
        "platform_joint_rate": _rates(tilt, time_s, sweep),
        "bar_angle": polar_rad - yaw,
    }


def _rates(angle_rad: Floats, time_s: Floats, sweep: NDArray[np.integer]) -> Floats:
    """Differentiate along each sweep; nought where a sweep has one sample."""
    rate = np.zeros_like(angle_rad)
    edges = np.concatenate([[0], np.flatnonzero(np.diff(sweep)) + 1, [len(sweep)]])
    for first, last in pairwise(edges):
        if last - first > 1:
            rate[first:last] = np.gradient(angle_rad[first:last], time_s[first:last], axis=0)
    return rate
