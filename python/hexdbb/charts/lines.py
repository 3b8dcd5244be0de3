"""Lines of a circle's charts: paths about the measured centre, closed and broken, smoothed residuals, shared marks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from hexdbb.comparison import QUANTITIES, UM_PER_MM, CircleComparison
from hexdbb.comparison.circles import SHORT_DIRECTION_NAMES, DirectionComparison
from hexdbb.comparison.iso230 import FULL_TURN_RAD, MAX_GAP_RAD, FloatArray, Path
from hexdbb.comparison.reversals import Reversal

SMOOTHED_OVER_DEG = 3
"""Arc over which the dark residual line is averaged; a divisor of 360."""
BREAK_DEG = 15
"""Arc without a sample at which the line breaks; fast circles may have one in four degrees only."""
NEAR_DEG = 7.0
"""Reversals nearer than this share one name: the names would cover one another."""


def drawn_paths(circle: CircleComparison) -> list[tuple[int, Path, Path]]:
    """Return direction, measured and predicted path of each direction, the measured centre offset removed from both."""
    centre = circle.set_up_centre_mm
    return [
        (part.direction, part.measured, part.predicted)
        if centre is None
        else (part.direction, part.measured.about(centre), part.predicted.about(centre))
        for part in circle.directions
    ]


def largest_drawn_mm(circles: Iterable[CircleComparison]) -> float:
    """Return the largest absolute deviation that the plots of these circles show."""
    return max(
        float(np.abs(path.deviation_mm).max())
        for circle in circles
        for _, *paths in drawn_paths(circle)
        for path in paths
    )


def curve(path: Path) -> tuple[FloatArray, FloatArray]:
    """Return angle (rad) and deviation (µm) of a path as a line: closed, and broken where samples are missing."""
    angle = np.append(path.angle_rad, path.angle_rad[0] + FULL_TURN_RAD)
    deviation_um = UM_PER_MM * np.append(path.deviation_mm, path.deviation_mm[0])
    gaps = np.flatnonzero(np.diff(angle) > MAX_GAP_RAD) + 1
    return np.insert(angle, gaps, np.nan), np.insert(deviation_um, gaps, np.nan)


def residual_path(part: DirectionComparison) -> Path:
    """Return the residual of the mean of the laps as a path."""
    measured, predicted = part.measured, part.predicted
    return Path(measured.angle_rad, measured.deviation_mm - predicted.deviation_mm, measured.nominal_radius_mm)


def smoothed(residual: Path) -> tuple[FloatArray, FloatArray]:
    """Return middle angle (deg) and mean (µm) of each arc with a sample; nan where the line breaks (`BREAK_DEG`)."""
    count = 360 // SMOOTHED_OVER_DEG
    arc = np.minimum((np.degrees(residual.angle_rad) // SMOOTHED_OVER_DEG).astype(np.int64), count - 1)
    samples = np.bincount(arc, minlength=count)
    total_um = UM_PER_MM * np.bincount(arc, weights=residual.deviation_mm, minlength=count)
    there = np.flatnonzero(samples)
    angle_deg = (there + 0.5) * SMOOTHED_OVER_DEG
    breaks = np.flatnonzero(np.diff(angle_deg) > BREAK_DEG) + 1
    return np.insert(angle_deg, breaks, np.nan), np.insert(total_um[there] / samples[there], breaks, np.nan)


def quantity_rows(circle: CircleComparison) -> Iterator[tuple[str, float | None, float | None]]:
    """Yield label, measured and predicted value (mm) of each quantity: once per direction, or once for both."""
    for quantity in QUANTITIES:
        parts = circle.directions[:1] if quantity.of_both else circle.directions
        for part in parts:
            label = (
                quantity.symbol if quantity.of_both else f"{quantity.symbol}, {SHORT_DIRECTION_NAMES[part.direction]}"
            )
            yield label, part.measured_quantities[quantity.key], part.predicted_quantities[quantity.key]


def near(reversals: Sequence[Reversal], apart_deg: float = NEAR_DEG) -> Iterator[list[Reversal]]:
    """Yield reversals, by angle, that share one name: those of a group span no more than `apart_deg`."""
    group: list[Reversal] = []
    for each in sorted(reversals, key=lambda each: each.angle_deg):
        if group and each.angle_deg - group[0].angle_deg > apart_deg:
            yield group
            group = []
        group.append(each)
    if group:
        yield group
