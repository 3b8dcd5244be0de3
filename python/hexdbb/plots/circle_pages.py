"""Pictures of circles: one with its quantities, a row for each feed, and many small ones side by side."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hexdbb.charts.lines import SMOOTHED_OVER_DEG, largest_drawn_mm
from hexdbb.charts.magnification import choose_scale
from hexdbb.comparison import UM_PER_MM, CircleComparison, iso230
from hexdbb.plan import Circle
from hexdbb.plots.panels import draw_quantities, draw_residual
from hexdbb.plots.polar import draw_polar, legend_handles
from hexdbb.plots.rooms import Room, label_at_once, panels, titled
from hexdbb.plots.style import sheet, styled

FEEDS_OF_A_SHEET = 2
FEED_IN = 5.2
"""Height of a feed's row, inches: the table has up to 15 lines of text."""
RESIDUAL_IN = (3.0, 1.4)
"""Width and height of the residual's panel without its labels, inches, about."""
DIAL_ROOM, BESIDE_ROOM = Room(0.0, 0.1, 0.45, 0.75), Room(top=0.33, bottom=0.38)
CIRCLE_FOOT_IN = 0.6
"""Room around the panels, and height of the legend with its two lines of notes, inches."""
OVERVIEW_COLUMNS = 4
OVERVIEW_ROOM, OVERVIEW_FOOT_IN = Room(0.06, 0.06, 0.62, 0.02), 0.68
OVERVIEW_IN = 2.35
"""Height of a row of small circles, inches."""
OVERVIEW_OF_A_SHEET = 16


@styled
def circle_page(circles: Sequence[CircleComparison], meant: Sequence[str] = (), heading: str = "") -> Figure:
    """Draw one circle: for each feed a polar plot, the residual against angle and the quantities.

    Reversals of the sliders `meant` (``slider 4``) are marked in bold; the heading stands above all.
    """
    figure = sheet(FEED_IN * len(circles) + 1.1)
    title = f"{circles[0].record_name}, {describe_circle(circles[0].circle)}"
    head_in, rows = titled(figure, f"{heading}\n{title}" if heading else title), len(circles)
    dials = panels(figure, (rows, 1), DIAL_ROOM, head_in, CIRCLE_FOOT_IN, (0.0, 0.5))
    beside = panels(figure, (2 * rows, 1), BESIDE_ROOM, head_in, CIRCLE_FOOT_IN, (0.5, 1.0), [1.0, 1.6] * rows)
    for row, circle in enumerate(circles):
        draw_circle(figure.add_subplot(dials[row, 0]), circle, meant)
        residual = figure.add_subplot(beside[2 * row, 0])
        draw_residual(residual, circle, RESIDUAL_IN, meant)
        label_at_once(residual)
        draw_quantities(figure.add_subplot(beside[2 * row + 1, 0]), circle)
    add_legend(
        figure,
        f"quantities of {iso230.EDITION}; F: centre offset removed (least squares), F*: kept\n"
        f"residual: every angle in light, mean of {SMOOTHED_OVER_DEG} deg in dark",
    )
    return figure


def draw_circle(axes: Axes, circle: CircleComparison, meant: Sequence[str]) -> None:
    """Draw a circle large, with its feed above, its scale and its centre offset below."""
    scale = choose_scale(circle.circle.radius_mm, largest_drawn_mm([circle]))
    draw_polar(axes, circle, scale, fine=True, meant=meant)
    axes.set_title(f"{circle.feed_mm_min:g} mm/min", fontweight="bold", pad=16.0)
    _below(axes, f"deviation: {scale.label}\n{_offset_note(circle)}")


@styled
def overview_page(circles: Sequence[CircleComparison], title: str, meant: Sequence[str] = ()) -> Figure:
    """Draw circles small, in the order given, each at its own magnification."""
    rows = -(-len(circles) // OVERVIEW_COLUMNS)
    figure = sheet(OVERVIEW_IN * rows + 1.3)
    head_in = titled(figure, title)
    grid = panels(figure, (rows, OVERVIEW_COLUMNS), OVERVIEW_ROOM, head_in, OVERVIEW_FOOT_IN)
    several_records = len({circle.record_name for circle in circles}) > 1
    for place, circle in enumerate(circles):
        axes = figure.add_subplot(grid[divmod(place, OVERVIEW_COLUMNS)])
        scale = choose_scale(circle.circle.radius_mm, largest_drawn_mm([circle]))
        draw_polar(axes, circle, scale, fine=False, meant=meant)
        record = f"{circle.record_name}\n" if several_records else ""
        axes.set_title(
            f"{record}circle {circle.circle.id}, {circle.feed_mm_min:g} mm/min\n{_both_directions(circle)}"
            f"residual RMS {UM_PER_MM * circle.rms_mm:.2f} µm\n"
            f"division {scale.division_um:g} µm, × {scale.magnification:g}"
        )
    add_legend(figure, f"G(b): bi-directional circular deviation, {iso230.EDITION}, measured / predicted")
    return figure


def describe_circle(circle: Circle) -> str:
    """Return the set-up of a circle in words, on two lines."""
    plane, platform = (
        "/".join(f"{value + 0.0:g}" for value in rpy) for rpy in (circle.plane_rpy_deg, circle.platform_rpy_deg)
    )
    return (
        f"circle {circle.id}: radius {circle.radius_mm:g} mm, mount {circle.mount}\n"
        f"roll/pitch/yaw of plane {plane} deg, of platform {platform} deg"
    )


def add_legend(figure: Figure, note: str) -> None:
    """Name the lines of polar plots below a picture, above them a note."""
    figure.legend(handles=legend_handles(), loc="outside lower center", ncols=3, title=note)


def _below(axes: Axes, text: str) -> None:
    axes.text(0.5, -0.08, text, transform=axes.transAxes, ha="center", va="top", linespacing=1.3)


def _offset_note(circle: CircleComparison) -> str:
    centre = circle.set_up_centre_mm
    if centre is None:
        return "not a full circle: centre offset not removed"
    x_um, y_um = UM_PER_MM * centre
    return f"centre offset of the set-up removed\n(least squares): {x_um:+.2f}, {y_um:+.2f} µm"


def _both_directions(circle: CircleComparison) -> str:
    part, key = circle.directions[0], "bidirectional_circular_deviation"
    measured_mm, predicted_mm = part.measured_quantities[key], part.predicted_quantities[key]
    if measured_mm is None or predicted_mm is None:
        return ""
    return f"G(b) {UM_PER_MM * measured_mm:.1f} / {UM_PER_MM * predicted_mm:.1f} µm\n"
