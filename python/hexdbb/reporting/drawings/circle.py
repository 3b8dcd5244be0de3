"""The polar plot of one circle at one feed: both directions, measured and predicted, deviations magnified.

The nominal circle has radius `NOMINAL` in the drawing; a deviation is drawn on top of it at the stated magnification.
The script of the page reads angle and deviation back from the drawn paths, so that no number is in the file twice.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from hexdbb.charts import Scale, choose_scale, screened
from hexdbb.charts.lines import curve, drawn_paths, largest_drawn_mm, near
from hexdbb.comparison import UM_PER_MM, CircleComparison
from hexdbb.comparison.circles import SHORT_DIRECTION_NAMES
from hexdbb.comparison.iso230 import Path
from hexdbb.reporting.drawings.svg import chart, element, label, path

NOMINAL = 108.0
"""Radius of the nominal circle, drawing units; deviations reach to 1.4 times it."""
HALF = 184.0
"""Half the width of the drawing: deviations, then the reversals' names."""
COLUMNS = 180
"""Arcs of which each keeps its extremes: two degrees are 4 drawing units at the nominal circle, the width of a line."""
MARK, NAME = 158.0, 171.0
"""Radii at which reversals are marked and named."""


def scale_of(circle: CircleComparison) -> Scale:
    """Return the magnification and the division of a circle's rings."""
    return choose_scale(circle.circle.radius_mm, largest_drawn_mm([circle]))


def polar_svg(circle: CircleComparison, meant: Sequence[str] = ()) -> str:
    """Draw a circle; reversals of the sliders meant (``slider 4``) are bold."""
    scale = scale_of(circle)
    per_um = NOMINAL / (UM_PER_MM * circle.circle.radius_mm) * scale.magnification
    title = (
        f"Polar plot of circle {circle.circle.id} at {circle.feed_mm_min:g} mm/min: measured and predicted paths of"
        f" both directions, {scale.label}"
    )
    inside = [*_rings(scale, per_um), *_marks(circle, meant), *_paths(circle, per_um)]
    return chart(
        title,
        (-HALF, -HALF, 2.0 * HALF, 2.0 * HALF),
        inside,
        class_="polar",
        data_nominal=NOMINAL,
        data_per_um=per_um,
        data_magnification=scale.magnification,
        data_division=scale.division_um,
    )


def _rings(scale: Scale, per_um: float) -> Iterator[str]:
    for step in range(-scale.divisions, scale.divisions + 1):
        radius = NOMINAL + step * scale.division_um * per_um
        if radius > 0.0:
            yield element("circle", r=radius, fill="none", class_="ring" if step else "nominal", data_step=step)
    for angle_deg in range(0, 360, 45):
        x, y = _at(angle_deg, MARK - 4.0)
        yield element("line", x1=0, y1=0, x2=x, y2=y, class_="ring")
        if angle_deg % 90 == 0:
            x, y = _at(angle_deg, 40.0)
            yield label(f"{angle_deg}°", x, y + 4.0, text_anchor="middle", class_="tick")


def _marks(circle: CircleComparison, meant: Sequence[str]) -> Iterator[str]:
    for group in near(circle.reversals):
        angle_deg = sum(each.angle_deg for each in group) / len(group)
        kind = "reversal meant" if any(f"slider {each.slider}" in meant for each in group) else "reversal"
        (x1, y1), (x2, y2), (x, y) = (_at(angle_deg, radius) for radius in (MARK - 8.0, MARK, NAME))
        yield element("line", x1=x1, y1=y1, x2=x2, y2=y2, class_=kind)
        name = ",".join(str(each) for each in dict.fromkeys(each.slider for each in group))
        yield label(name, x, y + 4.0, text_anchor="middle", class_=f"{kind} name")


def _paths(circle: CircleComparison, per_um: float) -> Iterator[str]:
    drawn = drawn_paths(circle)
    for kind in (0, 1):
        for direction, *paths in drawn:
            side = SHORT_DIRECTION_NAMES[direction]
            yield _line(paths[kind], per_um, f"{('measured', 'predicted')[kind]} {side}")


def _line(line: Path, per_um: float, kind: str) -> str:
    angle_rad, deviation_um = curve(line)
    kept = screened(angle_rad, deviation_um, COLUMNS)
    radius = NOMINAL + per_um * deviation_um[kept]
    return path(radius * np.cos(angle_rad[kept]), -radius * np.sin(angle_rad[kept]), class_=kind)


def _at(angle_deg: float, radius: float) -> tuple[float, float]:
    angle_rad = math.radians(angle_deg)
    return radius * math.cos(angle_rad), -radius * math.sin(angle_rad)
