"""Where the residual is largest: arcs of ten degrees of one circle, direction and feed, worst first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hexdbb.comparison.circles import DIRECTION_NAMES, CircleComparison, DirectionComparison, root_mean_square

ARC_DEG = 10
"""Width of the arcs by which the residual is sorted, a divisor of 360: enough samples to average the noise out."""


@dataclass(frozen=True)
class WorstArc:
    """One arc: `where` in words and as values, and the residual's root mean square there."""

    where: str
    record_name: str
    circle: int
    direction: int
    feed_mm_min: float
    angle_from_deg: int
    angle_to_deg: int
    rms_mm: float


def worst_arcs(circles: Sequence[CircleComparison], count: int) -> list[WorstArc]:
    """Return the `count` arcs with the largest root mean square residual, largest first."""
    several_records = len({circle.record_name for circle in circles}) > 1
    arcs = [arc for circle in circles for part in circle.directions for arc in _arcs(circle, part, several_records)]
    return sorted(arcs, key=lambda arc: arc.rms_mm, reverse=True)[:count]


def _arcs(circle: CircleComparison, part: DirectionComparison, name_record: bool) -> list[WorstArc]:
    prefix = f"{circle.record_name}, " if name_record else ""
    sweep = f"{prefix}circle {circle.circle.id}, {DIRECTION_NAMES[part.direction]}, {circle.feed_mm_min:g} mm/min"
    # The small summand keeps an angle that is meant to be the start of an arc out of the arc before it.
    arc_of = np.floor(np.degrees(part.angle_rad) / ARC_DEG + 1e-9).astype(np.int64) % (360 // ARC_DEG)
    return [
        WorstArc(
            where=f"{sweep}, angle {start}-{start + ARC_DEG} deg",
            record_name=circle.record_name,
            circle=circle.circle.id,
            direction=part.direction,
            feed_mm_min=circle.feed_mm_min,
            angle_from_deg=start,
            angle_to_deg=start + ARC_DEG,
            rms_mm=root_mean_square(part.residual_mm[arc_of == arc]),
        )
        for arc in np.unique(arc_of)
        for start in [int(arc) * ARC_DEG]
    ]
