"""How the legs swing about their guideways and the bar in the platform: what the engine's state does not hold.

At the slider's end a leg swings about its guideway (`swing_angle`); the bar's angle in the platform differs from the
commanded polar angle by the platform's yaw. Of the nominal machine; rates are central differences along each sweep.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.kinematics import engine_machine, forward
from hexdbb.samples import Samples

Floats = NDArray[np.float64]


def joint_state(samples: Samples) -> dict[str, Floats]:
    """Return the legs' swing (rad) and its rate (rad/s), the bar's angle in the platform, yaw and tilt."""
    sliders_mm = samples["sliders_mm"]
    position_mm, rotation, _ = forward(samples.machine, sliders_mm)
    nominal = engine_machine(samples.machine)
    swing = np.empty(sliders_mm.shape)
    for leg in range(6):
        guideway = leg // 2
        axes = _core.guideway_axes(guideway)
        foot = _core.guideway_vertex(nominal, guideway) + sliders_mm[:, [leg]] * _core.guideway_direction(guideway)
        along = position_mm + rotation @ _core.platform_joint(nominal, guideway) - foot
        swing[:, leg] = np.arctan2(along @ axes[:, 2], along @ axes[:, 0])
    yaw = np.arctan2(rotation[:, 1, 0], rotation[:, 0, 0])
    return {
        "swing_angle": swing,
        "swing_rate": _rates(swing, samples["time_s"], samples["sweep"]),
        "bar_angle": samples["angle_rad"] - yaw,
        "yaw": yaw,
        "tilt_x": rotation[:, 2, 0],
        "tilt_y": rotation[:, 2, 1],
    }


def _rates(angle_rad: Floats, time_s: Floats, sweep: NDArray[np.integer]) -> Floats:
    """Differentiate along each sweep; nought where a sweep has one sample."""
    rate = np.zeros_like(angle_rad)
    edges = np.concatenate([[0], np.flatnonzero(np.diff(sweep)) + 1, [len(sweep)]])
    for first, last in pairwise(edges):
        if last - first > 1:
            rate[first:last] = np.gradient(angle_rad[first:last], time_s[first:last], axis=0)
    return rate
