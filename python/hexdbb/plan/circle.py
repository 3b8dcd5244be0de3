"""One circular test: cup, circle of the centre ball, orientation of the platform, and the resulting poses.

Formula: with polar angle a, cup c and Rp = Rz(yaw) Ry(pitch) Rx(roll) of the circle's plane, the centre ball moves on
    ball(a) = c + Rp (radius cos a, radius sin a, 0),
and with the platform held at R the platform's reference point is p(a) = ball(a) - R ball_offset.
Assumption: the radius equals the bar's length within the gauge's range; the cup is the centre of the circle.
"""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field

from hexdbb.files.validation import Positive, StrictModel, Vector3
from hexdbb.kinematics import rotation_from_rpy
from hexdbb.plan.mount import Identity

Direction = Literal[1, -1]
"""+1 counter-clockwise seen from above the circle's plane, -1 clockwise."""
Feeds = Annotated[tuple[Positive, ...], Field(strict=False, min_length=1)]
Directions = Annotated[tuple[Direction, ...], Field(strict=False, min_length=1)]
Laps = Annotated[int, Field(ge=1, le=2**31 - 1)]
"""Captured turns; a record holds the number of a turn as int32."""


class Circle(StrictModel):
    """One circle of the centre ball about a cup; feeds, directions and laps replace those of the plan where given."""

    id: Identity
    """Number of the circle, unique in its file."""
    mount: Identity
    """`id` of the mount that the circle is centred on."""
    radius_mm: Positive
    """Commanded radius; in a plan equal to `gauge.bar_length_mm` within `gauge.range_um`."""
    ball_offset_mm: Vector3
    """Position of the centre ball (x, y, z), platform frame."""
    plane_rpy_deg: Vector3 = (0.0, 0.0, 0.0)
    """Roll, pitch, yaw of the circle's plane; zero is horizontal. Not limited to one turn."""
    platform_rpy_deg: Vector3 = (0.0, 0.0, 0.0)
    """Roll, pitch, yaw of the platform, held during the circle. Not limited to one turn."""
    feeds_mm_min: Feeds | None = None
    """Feeds of this circle in place of the plan's."""
    directions: Directions | None = None
    """Directions of this circle in place of the plan's."""
    laps: Laps | None = None
    """Captured laps of this circle in place of the plan's."""

    @property
    def platform_rpy_rad(self) -> NDArray[np.float64]:
        """Roll, pitch, yaw of the platform, rad, shape (3,)."""
        rpy_rad: NDArray[np.float64] = np.radians(np.array(self.platform_rpy_deg))
        return rpy_rad

    def ball_mm(self, angle_rad: ArrayLike, cup_mm: ArrayLike) -> NDArray[np.float64]:
        """Compute positions of the centre ball on its circle.

        Parameters
        ----------
        angle_rad : array_like, shape (n,) or ()
            Polar angle in the circle's plane, rad; need not be wrapped.
        cup_mm : array_like, shape (3,)
            Centre of the circle, base frame, mm.

        Returns
        -------
        ndarray, shape (n, 3)
            Base frame, mm.
        """
        angle = np.atleast_1d(np.asarray(angle_rad, dtype=np.float64))
        in_plane = self.radius_mm * np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=1)
        plane = rotation_from_rpy(np.radians(self.plane_rpy_deg))
        return np.asarray(cup_mm, dtype=np.float64) + in_plane @ plane.T

    def poses(self, angle_rad: ArrayLike, cup_mm: ArrayLike) -> NDArray[np.float64]:
        """Compute the platform reference points that put the ball on its circle at orientation `platform_rpy_deg`.

        Parameters
        ----------
        angle_rad, cup_mm : array_like
            As for `ball_mm`.

        Returns
        -------
        ndarray, shape (n, 3)
            Positions p in mm, base frame; the orientation of each is `platform_rpy_rad`.
        """
        offset: NDArray[np.float64] = rotation_from_rpy(self.platform_rpy_rad) @ np.asarray(self.ball_offset_mm)
        return self.ball_mm(angle_rad, cup_mm) - offset
