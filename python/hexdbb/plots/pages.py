"""The pages of a comparison: one per circle with a row for each feed, and an overview where there are several circles.

Figures are made without pyplot, so drawing keeps no state and opens no window.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, cast

import matplotlib as mpl
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.projections.polar import PolarAxes
from matplotlib.text import Text

from hexdbb.charts.lines import SMOOTHED_OVER_DEG, largest_drawn_mm
from hexdbb.charts.magnification import choose_scale
from hexdbb.comparison import UM_PER_MM, CircleComparison, Comparison, iso230
from hexdbb.files.atomic_file import replacing, require_folder
from hexdbb.files.plain_text import printable
from hexdbb.plan import Circle
from hexdbb.plots.panels import draw_quantities, draw_residual
from hexdbb.plots.polar import draw_polar, legend_handles
from hexdbb.plots.residual_pages import directions_page, harmonics_page, predictors_page

OVERVIEW_COLUMNS = 4
TICK_FORMULA = "\\mathdefault"
"""Part of the formulas that matplotlib itself makes, for tick labels of powers."""
FORMATS: dict[str, dict[str, Any]] = {".png": {"dpi": 150}, ".svg": {"metadata": {"Date": None}}}
"""Suffix of a picture's file to the options it is drawn with."""


@dataclass(frozen=True)
class Page:
    """One picture: `suffix` to add to the files' stem, and the function that draws it."""

    suffix: str
    draw: Callable[[], Figure]


def comparison_pages(comparison: Comparison) -> list[Page]:
    """List the pages of a comparison: one circle makes one page, several make an overview and a page each.

    Three pages of the residual follow: against each predictor, both directions combined, harmonics.
    """
    grouped: dict[tuple[str, int], list[CircleComparison]] = {}
    for circle in comparison.circles:
        grouped.setdefault((circle.record_name, circle.circle.id), []).append(circle)
    residual = _residual_pages(comparison)
    meant = () if comparison.cause is None else comparison.cause.subjects
    if len(grouped) == 1:
        return [Page("", partial(circle_page, comparison.circles, meant)), *residual]
    names = list(dict.fromkeys(record for record, _ in grouped))
    pages = [Page("", partial(overview_page, comparison))]
    for (record, identity), circles in grouped.items():
        # The number keeps records apart whose names differ only in their directory or suffix.
        prefix = f"-{names.index(record) + 1}-{Path(record).stem}" if len(names) > 1 else ""
        pages.append(Page(f"{prefix}-circle{identity}", partial(circle_page, circles, meant)))
    return [*pages, *residual]


def _residual_pages(comparison: Comparison) -> list[Page]:
    """List the pages of the residual; those with nothing to show are left out."""
    pages = [Page("-state", partial(predictors_page, comparison))]
    if any(circle.both_directions is not None for circle in comparison.circles):
        pages.append(Page("-directions", partial(directions_page, comparison)))
    if any(part.harmonics for circle in comparison.circles for part in circle.directions):
        pages.append(Page("-harmonics", partial(harmonics_page, comparison)))
    return pages


def circle_page(circles: Sequence[CircleComparison], meant: Sequence[str] = ()) -> Figure:
    """Draw one circle: for each feed a polar plot, the residual against angle and the quantities.

    Reversals of the sliders `meant` (``slider 4``) are marked in bold.
    """
    figure = Figure(figsize=(11.5, 5.9 * len(circles) + 0.8), layout="constrained")
    rows = figure.subfigures(len(circles), 1, squeeze=False)[:, 0]
    for circle, row in zip(circles, rows, strict=True):
        row.suptitle(f"{circle.feed_mm_min:g} mm/min", fontsize=10, fontweight="bold")
        left, right = row.subfigures(1, 2, width_ratios=[1.0, 1.0])
        scale = choose_scale(circle.circle.radius_mm, largest_drawn_mm([circle]))
        polar = cast(PolarAxes, left.subplots(subplot_kw={"projection": "polar"}))
        draw_polar(polar, circle, scale, fine=True)
        polar.set_xlabel(f"{scale.label}\n{_offset_note(circle)}", fontsize=8)
        residual, table = right.subplots(2, 1, height_ratios=[1.0, 1.25])
        draw_residual(residual, circle, meant)
        draw_quantities(table, circle)
    figure.suptitle(f"{circles[0].record_name}, {describe_circle(circles[0].circle)}", fontsize=11)
    _add_legend(
        figure,
        f"quantities of {iso230.EDITION}; F: centre offset removed (least squares), F*: kept; "
        f"residual: every angle in light, mean of {SMOOTHED_OVER_DEG} deg in dark",
    )
    return figure


def overview_page(comparison: Comparison) -> Figure:
    """Draw every circle at every feed small, the largest residual first, each at its own magnification."""
    circles = sorted(comparison.circles, key=lambda circle: -circle.rms_mm)
    rows = -(-len(circles) // OVERVIEW_COLUMNS)
    figure = Figure(figsize=(11.5, 3.4 * rows + 1.2), layout="constrained")
    grid = figure.subplots(rows, OVERVIEW_COLUMNS, squeeze=False, subplot_kw={"projection": "polar"})
    several_records = len({circle.record_name for circle in circles}) > 1
    for axes, circle in zip(grid.flat, circles, strict=False):
        scale = choose_scale(circle.circle.radius_mm, largest_drawn_mm([circle]))
        draw_polar(axes, circle, scale, fine=False)
        record = f"{circle.record_name}\n" if several_records else ""
        axes.set_title(
            f"{record}circle {circle.circle.id}, {circle.feed_mm_min:g} mm/min\n"
            f"{_both_directions(circle)}residual RMS {UM_PER_MM * circle.rms_mm:.2f} µm\n{scale.label}",
            fontsize=8,
        )
    for axes in grid.flat[len(circles) :]:
        axes.set_axis_off()
    name = "several records" if several_records else circles[0].record_name
    rms_um, peak_um = UM_PER_MM * comparison.rms_mm, UM_PER_MM * comparison.peak_to_valley_mm
    figure.suptitle(
        f"{name}, measured and predicted: residual RMS {rms_um:.2f} µm, peak to valley {peak_um:.2f} µm\n"
        "largest residual first; centre offset of each set-up removed (least squares)",
        fontsize=11,
    )
    _add_legend(figure, f"G(b): bi-directional circular deviation, {iso230.EDITION}, measured / predicted")
    return figure


def describe_circle(circle: Circle) -> str:
    """Return the set-up of a circle in words."""
    plane, platform = (
        "/".join(f"{value + 0.0:g}" for value in rpy) for rpy in (circle.plane_rpy_deg, circle.platform_rpy_deg)
    )
    return (
        f"circle {circle.id}: radius {circle.radius_mm:g} mm, mount {circle.mount}, "
        f"roll/pitch/yaw of plane {plane} deg, of platform {platform} deg"
    )


def save_figure(figure: Figure, stem: Path, suffixes: Sequence[str] = tuple(FORMATS)) -> list[Path]:
    """Write a figure as STEM.png and STEM.svg, or those of the suffixes named; the same figure gives the same bytes.

    Raises
    ------
    RunError
        A file cannot be written; what stood in its place is untouched.
    """
    FigureCanvasAgg(figure)
    _show_names_as_they_are(figure)
    written = []
    for suffix in suffixes:
        drawn = io.BytesIO()
        with mpl.rc_context({"svg.hashsalt": "hexdbb", "svg.fonttype": "none"}):
            figure.savefig(drawn, format=suffix[1:], **FORMATS[suffix])
        path = stem.with_name(stem.name + suffix)
        with replacing(path) as temporary:
            temporary.write_bytes(drawn.getvalue())
        written.append(path)
    return written


def _show_names_as_they_are(figure: Figure) -> None:
    """Turn off formulas in all texts but tick labels, so that "$" in the name of a record is shown as it is."""
    for text in figure.findobj(Text):
        # Tick labels are empty until they are drawn.
        if isinstance(text, Text) and text.get_text() and TICK_FORMULA not in text.get_text():
            text.set_parse_math(False)
            text.set_text(printable(text.get_text()))


def save_pages(pages: Sequence[Page], folder: Path) -> list[Path]:
    """Write pages into a folder, which is made where there is none; each page's suffix is its file's name.

    Raises
    ------
    InputError
        The folder cannot be made there.
    RunError
        A file cannot be written.
    """
    require_folder(folder)
    folder.mkdir(exist_ok=True)
    return [path for page in pages for path in save_figure(page.draw(), folder / page.suffix)]


def _offset_note(circle: CircleComparison) -> str:
    centre = circle.set_up_centre_mm
    if centre is None:
        return "not a full circle: centre offset not removed"
    x_um, y_um = UM_PER_MM * centre
    return f"centre offset of the set-up removed (least squares): {x_um:+.2f}, {y_um:+.2f} µm"


def _both_directions(circle: CircleComparison) -> str:
    part, key = circle.directions[0], "bidirectional_circular_deviation"
    measured_mm, predicted_mm = part.measured_quantities[key], part.predicted_quantities[key]
    if measured_mm is None or predicted_mm is None:
        return ""
    return f"G(b) {UM_PER_MM * measured_mm:.1f} / {UM_PER_MM * predicted_mm:.1f} µm, "


def _add_legend(figure: Figure, note: str) -> None:
    figure.legend(
        handles=legend_handles(),
        loc="outside lower center",
        ncols=5,
        fontsize=8,
        frameon=False,
        title=note,
        title_fontsize=8,
    )
