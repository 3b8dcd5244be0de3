"""The pictures of a comparison: what matters first, then all circles, each circle, and the residual.

Figures are made without pyplot, so drawing keeps no state and opens no window.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import TypeVar

from hexdbb.comparison import CircleComparison, Comparison
from hexdbb.comparison.circles import SHORT_DIRECTION_NAMES
from hexdbb.plots.circle_pages import FEEDS_OF_A_SHEET, OVERVIEW_OF_A_SHEET, circle_page, overview_page
from hexdbb.plots.residual_pages import (
    DIRECTIONS_OF_A_SHEET,
    HARMONICS_OF_A_SHEET,
    directions_page,
    harmonics_page,
    predictors_page,
)
from hexdbb.plots.saving import Page
from hexdbb.plots.summary import heading, meant_by, summary_page

Drawn = TypeVar("Drawn")


def comparison_pages(comparison: Comparison) -> list[Page]:
    """List the pages of a comparison, what matters first as the first, of empty suffix.

    Of one circle this is the circle itself; of several a summary, which an overview and a page for each circle follow.
    Then come pages of the residual: against each predictor, both directions combined, harmonics. What a sheet of paper
    has no room for goes on the next.
    """
    grouped: dict[tuple[str, int], list[CircleComparison]] = {}
    for circle in comparison.circles:
        grouped.setdefault((circle.record_name, circle.circle.id), []).append(circle)
    meant = meant_by(comparison)
    if len(grouped) == 1:
        drawn = partial(circle_page, meant=meant, heading=heading(comparison))
        sheets = _sheets("", comparison.circles, FEEDS_OF_A_SHEET)
        return [*(Page(suffix, partial(drawn, part)) for suffix, part in sheets), *_residual_pages(comparison)]
    ranked = sorted(comparison.circles, key=lambda circle: -circle.rms_mm)
    title = f"{heading(comparison)}\nlargest residual first; centre offset of each set-up removed (least squares)"
    pages = [Page("", partial(summary_page, comparison))]
    for suffix, part in _sheets("-overview", ranked, OVERVIEW_OF_A_SHEET):
        pages.append(Page(suffix, partial(overview_page, part, title, meant)))
    names = list(dict.fromkeys(record for record, _ in grouped))
    for (record, identity), circles in grouped.items():
        # The number keeps records apart whose names differ only in their directory or suffix.
        prefix = f"-{names.index(record) + 1}-{Path(record).stem}" if len(names) > 1 else ""
        for suffix, part in _sheets(f"{prefix}-circle{identity}", circles, FEEDS_OF_A_SHEET):
            pages.append(Page(suffix, partial(circle_page, part, meant)))
    return [*pages, *_residual_pages(comparison)]


def _residual_pages(comparison: Comparison) -> list[Page]:
    """List the pages of the residual; those with nothing to show are left out."""
    pages = [Page("-state", partial(predictors_page, comparison))]
    pairs = [circle for circle in comparison.circles if circle.both_directions is not None]
    pairs.sort(key=lambda circle: -circle.rms_mm)
    for suffix, part in _sheets("-directions", pairs, DIRECTIONS_OF_A_SHEET):
        pages.append(Page(suffix, partial(directions_page, part, meant_by(comparison))))
    rows = [
        (f"circle {circle.circle.id}, {circle.feed_mm_min:g}, {SHORT_DIRECTION_NAMES[part.direction]}", part.harmonics)
        for circle in comparison.circles
        for part in circle.directions
        if part.harmonics
    ]
    rows.sort(key=lambda row: -max(each.amplitude_mm for each in row[1]))
    for suffix, some in _sheets("-harmonics", rows, HARMONICS_OF_A_SHEET):
        pages.append(Page(suffix, partial(harmonics_page, some)))
    return pages


def _sheets(suffix: str, drawn: Sequence[Drawn], most: int) -> Iterator[tuple[str, Sequence[Drawn]]]:
    """Yield what fits on a sheet each, with the suffix: as given for the first, numbered from the second on."""
    for sheet, begin in enumerate(range(0, len(drawn), most)):
        yield (f"{suffix}-{sheet + 1}" if sheet else suffix), drawn[begin : begin + most]
