"""Points of the nominal machine in its base frame, for pictures of it: guideways, sliders, ball joints.

Source: thesis sections 2-1 and 2-2, Figure 2.2, as the engine has them (`machine.hpp`).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.kinematics.poses import engine_machine
from hexdbb.machine import MachineFile

Floats = NDArray[np.float64]
GUIDEWAYS = range(3)


def guideway_ends(machine: MachineFile) -> Floats:
    """Return the places of the sliders' joints at both ends of travel on each guideway, shape (3, 2, 3), mm."""
    engine = engine_machine(machine)
    return np.array(
        [
            _core.guideway_vertex(engine, i) + np.outer(np.array(travel_mm), _core.guideway_direction(engine, i))
            for i, travel_mm in enumerate(machine.sliders.guideway_travels_mm)
        ]
    )


def slider_points(machine: MachineFile, sliders_mm: Floats) -> Floats:
    """Return the legs' joints on the sliders.

    Parameters
    ----------
    machine : MachineFile
    sliders_mm : ndarray, shape (n, 6)

    Returns
    -------
    ndarray, shape (n, 6, 3)
        Base frame, mm.
    """
    engine = engine_machine(machine)
    vertices = np.repeat([_core.guideway_vertex(engine, i) for i in GUIDEWAYS], 2, axis=0)
    directions = np.repeat([_core.guideway_direction(engine, i) for i in GUIDEWAYS], 2, axis=0)
    points: Floats = vertices + sliders_mm[:, :, None] * directions
    return points


def platform_points(machine: MachineFile) -> Floats:
    """Return the ball joints of the legs on the platform, legs 1 to 6, shape (6, 3), platform frame, mm."""
    engine = engine_machine(machine)
    return np.repeat([_core.platform_joint(engine, i) for i in GUIDEWAYS], 2, axis=0)
