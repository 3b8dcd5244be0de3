"""What a machine is used for and how far its joints turn: optional tables of a machine file.

Angles are those of the nominal machine: of a leg and its guideway, of a leg and the platform's normal, and the swing of
a pair of legs about its guideway, the angle of the thesis' RSSR loops.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from hexdbb.files.validation import BadValueError, Number, Positive, StrictModel, Vector3

RightAngle = Annotated[float, Field(ge=0.0, le=90.0, allow_inf_nan=False)]
Swing = Annotated[tuple[Number, Number], Field(strict=False)]
Tilt = Annotated[float, Field(ge=0.0, lt=90.0, allow_inf_nan=False)]
NotNegativeLength = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]


class Joints(StrictModel):
    """How far the joints turn; what is absent is not limited."""

    leg_to_guideway_min_deg: RightAngle | None = None
    """Least angle of a leg and its guideway."""
    leg_to_normal_max_deg: RightAngle | None = None
    """Largest angle of a leg and the platform's normal."""
    swing_deg: Swing | None = None
    """Least and largest lean of a pair of legs from the vertical about its guideway, inward positive."""

    @model_validator(mode="after")
    def _ordered(self) -> Joints:
        if self.swing_deg is not None and self.swing_deg[0] >= self.swing_deg[1]:
            raise BadValueError(("swing_deg",), list(self.swing_deg), "the least angle before the largest")
        return self


class Workspace(StrictModel):
    """Where the platform is wanted: an upright cylinder of its reference point, and its tilt there."""

    centre_mm: Vector3
    """Middle of the cylinder (x, y, z), base frame."""
    radius_mm: Positive
    """Radius of the cylinder."""
    height_mm: NotNegativeLength = 0.0
    """Height of the cylinder; 0 is a disc."""
    tilt_deg: Tilt = 0.0
    """Largest tilt from level, to all sides, everywhere in it."""
