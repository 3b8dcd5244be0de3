"""The page of a fleet's report: one HTML file, in the style of the report of a test."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
from markupsafe import Markup

from hexdbb import __version__
from hexdbb.files.atomic_file import write_text
from hexdbb.fleet.growth import DAYS_PER_YEAR, Growth
from hexdbb.fleet.observed import SECONDS_PER_DAY, Floats
from hexdbb.fleet.report import FleetReport
from hexdbb.fleet.text import growth_words
from hexdbb.reporting.drawings.axes import Frame, round_ticks
from hexdbb.reporting.drawings.svg import chart, element, path
from hexdbb.reporting.templating import environment, style
from hexdbb.units import readable_unit

DRAWN = 8
"""Values drawn: the slopes that chance explains least; the table has all."""
WIDTH, HEIGHT = 300.0, 190.0
ROOM = 0.08
"""Empty part of a chart beyond its points, of their range."""


def write_fleet_page(report: FleetReport, file: Path) -> None:
    """Write the page, whole or not at all; `RunError` where it cannot be written."""
    write_text(file, fleet_page(report))


def fleet_page(report: FleetReport) -> str:
    """Return the page as HTML."""
    return (
        environment("hexdbb.fleet")
        .get_template("fleet.html")
        .render(
            style=style(),
            version=__version__,
            report=report,
            charts=[(growth_words(line), Markup(growth_svg(line))) for line in report.growing[:DRAWN]],
            readable_unit=readable_unit,
        )
    )


def growth_svg(line: Growth) -> str:
    """Draw a series over the years, with bars of one sigma where it is known, outliers as rings, and its line."""
    series = line.series
    years = _years(series.days)
    spread = np.nan_to_num(series.sigma)
    frame = Frame(
        WIDTH,
        HEIGHT,
        _widened(years, years),
        _widened(series.value - spread, series.value + spread),
    )
    x, y = frame.x(years), frame.y(series.value)
    unit = readable_unit(series.value_name.unit)
    inside = [
        *frame.grid(round_ticks(*frame.x_range, most=4), round_ticks(*frame.y_range), "year", unit),
        *(
            element("line", x1=across, x2=across, y1=low, y2=high, class_="ring")
            for across, low, high in zip(
                x.tolist(),
                frame.y(series.value - spread).tolist(),
                frame.y(series.value + spread).tolist(),
                strict=True,
            )
        ),
        *(
            element("circle", cx=across, cy=down, r=5.0 if far else 2.5, class_="dot held" if far else "dot fitted")
            for across, down, far in zip(x.tolist(), y.tolist(), line.outliers.tolist(), strict=True)
        ),
        path(x[[0, -1]], frame.y(np.array([line.at_first, line.at_last])), class_="only"),
    ]
    return chart(growth_words(line), frame.box, inside)


def _years(days: Floats) -> Floats:
    """Return days since 1970 as years of the calendar."""
    first = datetime.fromtimestamp(float(days[0]) * SECONDS_PER_DAY, UTC).year
    begins = datetime(first, 1, 1, tzinfo=UTC).timestamp() / SECONDS_PER_DAY
    return first + (days - begins) / DAYS_PER_YEAR


def _widened(lowest: Floats, highest: Floats) -> tuple[float, float]:
    low, high = float(lowest.min()), float(highest.max())
    room = ROOM * max(high - low, 1e-9)
    return low - room, high + room
