"""One circular test: which cup, which circle of the centre ball, how the platform is held, and the poses that make it.

Formula: with polar angle a, cup c and Rp = Rz(yaw) Ry(pitch) Rx(roll) of the circle's plane, the centre ball runs on
    ball(a) = c + Rp (radius cos a, radius sin a, 0),
and with the platform held at R the platform's reference point is p(a) = ball(a) - R ball_offset.
Assumption: the ball bar is as long as the circle's radius, so the cup is the centre of the circle.
"""

from __future__ import annotations

import math
from typing import Annotated, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field

from hexdbb.files.validation import NotNegative, Positive, StrictModel, Vector3
from hexdbb.kinematics import rotation_from_rpy

Identity = Annotated[int, Field(ge=0, le=2**31 - 1)]
"""Number by which samples and circles refer to a circle or a mount."""
Direction = Literal[1, -1]
"""+1 counter-clockwise seen from above the circle's plane, -1 clockwise."""
Feeds = Annotated[tuple[Positive, ...], Field(strict=False, min_length=1)]
Directions = Annotated[tuple[Direction, ...], Field(strict=False, min_length=1)]
Laps = Annotated[int, Field(ge=1)]


LEAST_NOISE_MM = 1e-6
"""A gauge is not taken to be better than a nanometre."""


class Gauge(StrictModel):
    """The ball bar and its length gauge."""

    bar_length_mm: Positive
    """L0: nominal distance between the two ball centres; the reading is the length minus this."""
    noise_um: NotNegative | None = None
    """Stated standard deviation of one reading; None where it is not known."""
    resolution_um: NotNegative = 0.1
    range_um: Positive = 1000.0
    """Largest reading, to either side."""

    @property
    def stated_noise_mm(self) -> float | None:
        """Standard deviation of one reading as stated, with its rounding; None where it is not.

        A rounded reading is off by up to half a step either way, evenly: standard deviation step / sqrt(12).
        """
        if self.noise_um is None:
            return None
        return max(math.hypot(self.noise_um, self.resolution_um / math.sqrt(12.0)) / 1000.0, LEAST_NOISE_MM)


class Mount(StrictModel):
    """One fixing of the tool cup on the base; its true position is an unknown of the fit."""

    id: Identity
    cup_mm: Vector3
    """Nominal centre of the cup, base frame."""


class Circle(StrictModel):
    """One circle of the centre ball about a cup; feeds, directions and laps stand in for the plan's where given."""

    id: Identity
    mount: Identity
    radius_mm: Positive
    ball_offset_mm: Vector3
    """Centre ball, platform frame."""
    plane_rpy_deg: Vector3 = (0.0, 0.0, 0.0)
    """Roll, pitch, yaw of the circle's plane; zero is horizontal."""
    platform_rpy_deg: Vector3 = (0.0, 0.0, 0.0)
    """Roll, pitch, yaw of the platform, held during the circle."""
    feeds_mm_min: Feeds | None = None
    directions: Directions | None = None
    laps: Laps | None = None

    @property
    def platform_rpy_rad(self) -> NDArray[np.float64]:
        """Roll, pitch and yaw of the platform, rad, shape (3,)."""
        rpy_rad: NDArray[np.float64] = np.radians(np.array(self.platform_rpy_deg))
        return rpy_rad

    def ball_mm(self, angle_rad: ArrayLike, cup_mm: ArrayLike) -> NDArray[np.float64]:
        """Centre ball on its circle.

        Parameters
        ----------
        angle_rad : array_like, shape (n,) or ()
            Polar angle in the circle's plane.
        cup_mm : array_like, shape (3,)
            Centre of the circle, base frame.

        Returns
        -------
        ndarray, shape (n, 3)
        """
        angle = np.atleast_1d(np.asarray(angle_rad, dtype=np.float64))
        in_plane = self.radius_mm * np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=1)
        plane = rotation_from_rpy(np.radians(self.plane_rpy_deg))
        return np.asarray(cup_mm, dtype=np.float64) + in_plane @ plane.T

    def poses(self, angle_rad: ArrayLike, cup_mm: ArrayLike) -> NDArray[np.float64]:
        """Platform reference point that puts the ball on its circle, the platform held at `platform_rpy_deg`.

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
