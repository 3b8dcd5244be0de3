"""What rocks a base that stands softly: the accelerations of all carriages, added as vectors.

The acceleration of a platform that is not turned is nearly in proportion to it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core

Floats = NDArray[np.float64]

REACTION = "carriages_acceleration_mm_s2"
REACTION_FROM = "acceleration_mm_s2"
"""Column that it follows from."""


def carriages_acceleration_mm_s2(machine: _core.Machine, acceleration_mm_s2: Floats) -> Floats:
    """Return the sum of the carriages' accelerations in the base's frame, shape (n, 3).

    Parameters
    ----------
    machine : Machine
    acceleration_mm_s2 : ndarray, shape (n, 6)
        Of the sliders, each along its guideway.
    """
    along = np.array([_core.guideway_direction(machine, slider // 2) for slider in range(acceleration_mm_s2.shape[1])])
    return np.asarray(acceleration_mm_s2 @ along)
