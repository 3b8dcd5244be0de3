"""Dimensions of a machine file: guideways, platform, legs, sliders.

Units: mm and deg in the file; rad as the properties with that unit in their names.
"""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import Field, model_validator

from hexdbb.files.validation import (
    ALIKE,
    EACH,
    ONE,
    BadValueError,
    Number,
    Positive,
    StrictModel,
    format_value,
    one_or_each,
)

Three = Annotated[tuple[Number, Number, Number], Field(strict=False)]
Pair = Annotated[tuple[Number, Number], Field(strict=False)]
SixPositive = Annotated[tuple[Positive, Positive, Positive, Positive, Positive, Positive], Field(strict=False)]
SixPairs = Annotated[tuple[Pair, Pair, Pair, Pair, Pair, Pair], Field(strict=False)]
Lengths = Annotated[Annotated[Positive, ONE] | Annotated[SixPositive, ALIKE, EACH], one_or_each()]
Travels = Annotated[Annotated[Pair, ONE] | Annotated[SixPairs, ALIKE, EACH], one_or_each(depth=1)]
ThreeFloats = tuple[float, float, float]

THIRDS_DEG = (0.0, 120.0, 240.0)
"""Directions of guideways and ball joints in the machine of the thesis."""
NEAREST_DEG = 30.0
"""Least angle between two guideways, or two ball joints: closer ones meet within the machine or leave the platform a
sliver, and a list in rad or with one angle typed twice is such a list."""


class Base(StrictModel):
    """Guideways about the base centre."""

    inradius_mm: Positive
    """BR: distance of each guideway from the base centre."""
    guideway_angles_deg: Three = THIRDS_DEG
    """Directions from the base centre to the nearest points of guideways 1 to 3, about z, counter-clockwise from the x
    axis seen from above; each runs across its direction."""

    @model_validator(mode="after")
    def _around(self) -> Base:
        _check_around("guideway_angles_deg", self.guideway_angles_deg)
        return self

    @property
    def guideway_angles_rad(self) -> ThreeFloats:
        """`guideway_angles_deg` in rad."""
        return _radians(self.guideway_angles_deg)


class Platform(StrictModel):
    """Moving platform."""

    circumradius_mm: Positive
    """UR: distance of each ball joint from the platform's axis."""
    joint_plane_height_mm: Number
    """IH: height of the ball joints above the platform's reference point."""
    moved_mass_kg: Positive
    """Mass of platform and tool, which loads the legs."""
    joint_angles_deg: Three = THIRDS_DEG
    """Directions of ball joints 1 to 3 about the platform's z axis, counter-clockwise from its x axis from above."""

    @model_validator(mode="after")
    def _around(self) -> Platform:
        _check_around("joint_angles_deg", self.joint_angles_deg)
        return self

    @property
    def joint_angles_rad(self) -> ThreeFloats:
        """`joint_angles_deg` in rad."""
        return _radians(self.joint_angles_deg)


class Legs(StrictModel):
    """Six legs."""

    length_mm: Lengths
    """l: distance between the two joints of a leg, one number or legs 1 to 6; long enough for the platform to stand
    centred and level."""

    @property
    def lengths_mm(self) -> tuple[float, ...]:
        """Lengths of legs 1 to 6."""
        return self.length_mm if isinstance(self.length_mm, tuple) else (self.length_mm,) * 6

    def length_key(self, leg: int) -> tuple[str | int, ...]:
        """Return the key that holds the length of a leg, counted from 0."""
        return ("length_mm", leg) if isinstance(self.length_mm, tuple) else ("length_mm",)


class Sliders(StrictModel):
    """Six sliders, two on each guideway."""

    travel_mm: Travels
    """Least and largest slider coordinate, the least first; one pair, or a list of sliders 1 to 6."""
    min_gap_mm: Positive
    """Least distance of two sliders on one guideway; less than the travel."""
    screw_lead_mm: Positive
    """Slider travel per turn of the screw."""

    @model_validator(mode="after")
    def _travel_holds_two_sliders(self) -> Sliders:
        for slider, (least, largest) in enumerate(self.travels_mm):
            if least >= largest:
                raise BadValueError(
                    self.travel_key(slider), [least, largest], "the least coordinate before the largest"
                )
        for least, largest in self.guideway_travels_mm:
            if self.min_gap_mm >= largest - least:
                raise BadValueError(("min_gap_mm",), self.min_gap_mm, f"less than the travel, {largest - least:g}")
        return self

    @property
    def travels_mm(self) -> tuple[tuple[float, float], ...]:
        """Travels of sliders 1 to 6."""
        return self.travel_mm if isinstance(self.travel_mm[0], tuple) else (self.travel_mm,) * 6

    @property
    def guideway_travels_mm(self) -> tuple[tuple[float, float], ...]:
        """The part of each guideway that its two sliders travel."""
        pairs = zip(self.travels_mm[::2], self.travels_mm[1::2], strict=True)
        return tuple((min(one[0], other[0]), max(one[1], other[1])) for one, other in pairs)

    def travel_key(self, slider: int) -> tuple[str | int, ...]:
        """Return the key that holds the travel of a slider, counted from 0."""
        return ("travel_mm", slider) if isinstance(self.travel_mm[0], tuple) else ("travel_mm",)


def _check_around(key: str, angles_deg: ThreeFloats) -> None:
    """Check that three directions go once around, counter-clockwise, none too near to the next."""
    for index, angle in enumerate(angles_deg):
        following = angles_deg[index + 1] if index < 2 else angles_deg[0] + 360.0
        if following - angle < NEAREST_DEG:
            least = f"beyond {format_value(angle)}" if index < 2 else f"before {following:g}, the first a turn later"
            at = min(index + 1, 2)
            expected = f"{NEAREST_DEG:g} or more {least}: counter-clockwise, once around"
            raise BadValueError((key, at), angles_deg[at], expected)


def _radians(angles_deg: ThreeFloats) -> ThreeFloats:
    one, two, three = (math.radians(each) for each in angles_deg)
    return one, two, three
