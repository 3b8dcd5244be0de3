"""Magnification: the scale of a polar plot's deviations against that of its circle.

A polar plot draws the nominal circle to one scale and the deviation from it to another. The magnification is the ratio
of the two: at 2000x, 1 µm of deviation is drawn as long as 2 mm of radius. It is a number of the series 1, 2, 5, 10, so
that plots of different circles can be compared, and is printed with the plot, as is the division of its grid.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

UM_PER_MM = 1e3
SERIES = (1.0, 2.0, 5.0)
LARGEST_SHARE_OF_RADIUS = 0.4
"""Largest length of a deviation in the drawing, as part of the nominal radius: the path stays a ring."""
SMALLEST_DEVIATION_UM = 0.1
"""Smallest deviation the scale is chosen for: below a gauge's resolution there is nothing to see."""


@dataclass(frozen=True)
class Scale:
    """Scale of one polar plot: `centre_um` is the deviation at which the radial axis has its origin."""

    magnification: float
    division_um: float
    divisions: int
    radius_mm: float

    @property
    def centre_um(self) -> float:
        """Deviation drawn at the centre of the plot: minus the radius, at the plot's magnification."""
        return -UM_PER_MM * self.radius_mm / self.magnification

    @property
    def label(self) -> str:
        """Text printed with the plot."""
        return f"1 division = {self.division_um:g} µm, magnification {self.magnification:g}x"


def choose_scale(radius_mm: float, largest_deviation_mm: float) -> Scale:
    """Choose magnification and division for deviations up to the given size, in either sense.

    Parameters
    ----------
    radius_mm : float
        Nominal radius.
    largest_deviation_mm : float
        Largest absolute deviation to be drawn.
    """
    largest_um = max(UM_PER_MM * largest_deviation_mm, SMALLEST_DEVIATION_UM)
    magnification = _series_at_most(LARGEST_SHARE_OF_RADIUS * UM_PER_MM * radius_mm / largest_um)
    division_um = _series_at_most(largest_um / 2.0)
    return Scale(magnification, division_um, math.ceil(largest_um / division_um - 1e-9), radius_mm)


def _series_at_most(value: float) -> float:
    """Largest number of the series 1, 2, 5, 10, ... that is not above the value."""
    decade = 10.0 ** math.floor(math.log10(value) + 1e-12)
    return float(f"{max(step for step in SERIES if step * decade <= value * (1.0 + 1e-12)) * decade:.6g}")
