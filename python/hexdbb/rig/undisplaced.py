"""The true machine at one instant after another where nothing displaces it: `Machine` in plain numbers.

Of six legs NumPy's calls take several times what their arithmetic does in plain numbers. Both agree to rounding
(tests).
Units: mm, rad.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hexdbb.errors import RunError
from hexdbb.rig.geometry import Array, TrueGeometry
from hexdbb.rig.single_pose import Rotation, Vector, solved


class Undisplaced:
    """The machine's pose, followed from place to place.

    Parameters
    ----------
    geometry : TrueGeometry
    position_mm, rotation : (3,) and (3, 3) arrays
        Approximate pose at the beginning, base frame.

    Attributes
    ----------
    position : tuple of float
        Platform, base frame, mm.
    rotation : tuple of tuple of float
        Rows of its rotation.
    """

    def __init__(self, geometry: TrueGeometry, position_mm: Array, rotation: Array) -> None:
        lines = zip(geometry.anchors_mm.tolist(), geometry.directions.tolist(), strict=True)
        platform = zip(geometry.joints_mm.tolist(), geometry.lengths_mm.tolist(), strict=True)
        each = zip(lines, platform, strict=True)
        self._legs = [(*anchor, *along, joint, length) for (anchor, along), (joint, length) in each]
        x, y, z = np.asarray(position_mm, dtype=float).tolist()
        first, second, third = np.asarray(rotation, dtype=float).tolist()
        self.position: Vector = (x, y, z)
        self.rotation: Rotation = (tuple(first), tuple(second), tuple(third))
        self._before = self._earlier = self.position

    def step(self, drive_mm: Sequence[float]) -> None:
        """Move to other drive positions, mm, shape (6,); raises `RunError` where the machine has no pose for them."""
        ends = [
            ((x + at * u, y + at * v, z + at * w), joint, length)
            for (x, y, z, u, v, w, joint, length), at in zip(self._legs, drive_mm, strict=True)
        ]
        x, y, z = self.position
        (a, b, c), (d, e, f) = self._before, self._earlier
        # Where the platform would be on the parabola through its last places: saves one of three iterations.
        guess = 3.0 * (x - a) + d, 3.0 * (y - b) + e, 3.0 * (z - c) + f
        self._before, self._earlier = self.position, self._before
        found = solved(ends, guess, self.rotation)
        if found is None:
            where = np.round(drive_mm, 3).tolist()
            raise RunError(f"the true machine has no pose for sliders {where} mm")
        self.position, self.rotation = found
