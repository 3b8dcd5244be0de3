"""Home: the platform level and untwisted over the base centre; at which heights its sliders allow it to stand there.

Model: with the ball joints' plane at height H above the guideways, leg k (length l, distance rho from its guideway in
plan view to the ball joint) spans u = sqrt(l^2 - rho^2 - H^2) along its guideway from the ball joint's foot f:
s = f - u for the first slider of a guideway, f + u for the second (thesis 2.6 to 2.8). A travel is a range of u, a
range of u is a range of H^2; two sliders keep their gap g where u_a + u_b >= g.
Units: mm, rad.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from hexdbb.machine.file import MachineFile

SQRT3 = math.sqrt(3.0)


@dataclass(frozen=True)
class HomeLeg:
    """One leg while the platform is level and untwisted over the base centre.

    Attributes
    ----------
    foot_mm : float
        Slider coordinate at the ball joint's foot on the guideway.
    aside_mm : float
        Distance of ball joint and guideway in plan view.
    length_mm : float
        Of the leg.
    is_first : bool
        Whether its slider is the one with the smaller coordinate.
    """

    foot_mm: float
    aside_mm: float
    length_mm: float
    is_first: bool

    @property
    def widest_mm(self) -> float:
        """Distance of slider and foot with the platform in the plane of the guideways; 0 where the leg is too short."""
        return math.sqrt(max(self.length_mm**2 - self.aside_mm**2, 0.0))

    def span_range_mm(self, travel_mm: tuple[float, float]) -> tuple[float, float]:
        """Return the least and largest distance of slider and foot that a travel allows; empty: least above largest."""
        least, largest = travel_mm
        near, far = (
            (self.foot_mm - largest, self.foot_mm - least)
            if self.is_first
            else (
                least - self.foot_mm,
                largest - self.foot_mm,
            )
        )
        return max(near, 0.0), min(far, self.widest_mm)

    def place_mm(self, span_mm: float) -> float:
        """Return the slider coordinate at a distance from the foot."""
        return self.foot_mm - span_mm if self.is_first else self.foot_mm + span_mm


def home_legs(machine: MachineFile) -> list[HomeLeg]:
    """Return the six legs of a machine at home."""
    base, platform = machine.base, machine.platform
    legs = []
    for k, length_mm in enumerate(machine.legs.lengths_mm):
        turned = platform.joint_angles_rad[k // 2] - base.guideway_angles_rad[k // 2]
        outward_mm = platform.circumradius_mm * math.cos(turned)
        foot_mm = SQRT3 * base.inradius_mm - platform.circumradius_mm * math.sin(turned)
        legs.append(HomeLeg(foot_mm, abs(base.inradius_mm - outward_mm), length_mm, k % 2 == 0))
    return legs


def gap_height_mm(first: HomeLeg, second: HomeLeg, gap_mm: float) -> float:
    """Return the height above which two sliders of a guideway are closer than a gap; negative where they always are."""
    a, b = first.widest_mm**2, second.widest_mm**2
    # From u_a + u_b = g and u_a^2 - u_b^2 = a - b.
    span_mm = 0.5 * (gap_mm + (a - b) / gap_mm)
    if not 0.0 <= span_mm <= gap_mm:  # one leg is upright before the sliders are so near
        return math.sqrt(min(a, b))
    return math.sqrt(a - span_mm**2) if a >= span_mm**2 else -1.0


def home_heights_mm(machine: MachineFile) -> tuple[float, float]:
    """Return the least and largest height of the ball joints above the guideways at home; empty: least above largest.

    The machine stands at home at every height between them.
    """
    legs = home_legs(machine)
    least, largest = 0.0, math.inf
    for leg, travel_mm in zip(legs, machine.sliders.travels_mm, strict=True):
        near, far = leg.span_range_mm(travel_mm)
        if far < near:
            return math.inf, 0.0
        least = max(least, math.sqrt(max(leg.widest_mm**2 - far**2, 0.0)))
        largest = min(largest, math.sqrt(max(leg.widest_mm**2 - near**2, 0.0)))
    for first, second in _pairs(legs):
        largest = min(largest, gap_height_mm(first, second, machine.sliders.min_gap_mm))
    return least, largest


def _pairs(legs: list[HomeLeg]) -> Iterator[tuple[HomeLeg, HomeLeg]]:
    yield from zip(legs[::2], legs[1::2], strict=True)
