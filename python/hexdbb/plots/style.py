"""The style sheet of all pictures: sizes for A4 paper, and the colours that pages have too.

A picture is drawn at the size at which it is printed: no wider and no higher than a sheet, no text under 8 points. Its
figure is finished (`styled`) when the function that draws it returns, so that it may be saved in any format without
being laid out again, which takes matplotlib longer than all drawing.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from typing import Any, ParamSpec

import matplotlib as mpl
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text

from hexdbb.charts.colours import GRID_COLOUR, NOMINAL_COLOUR, PAPER_COLOUR, TEXT_COLOUR
from hexdbb.files.plain_text import printable

PAGE_IN = (8.27, 11.69)
"""Width and greatest height of a picture, inches: A4."""
SIDE_MARGIN = 0.05
"""Part of the sheet's width left white on either side: printers leave 5 to 10 mm."""
PNG_DPI = 150
TEXT_PT, TITLE_PT = 8.0, 10.0
"""Size of text, points: 8 is the least that is read at arm's length; and of a picture's title."""
STYLE: Any = {
    "font.size": TEXT_PT,
    "axes.titlesize": TEXT_PT,
    "axes.titley": 1.0,
    "axes.labelsize": TEXT_PT,
    "xtick.labelsize": TEXT_PT,
    "ytick.labelsize": TEXT_PT,
    "legend.fontsize": TEXT_PT,
    "legend.title_fontsize": TEXT_PT,
    "legend.frameon": False,
    "legend.borderaxespad": 1.2,
    "figure.titlesize": TITLE_PT,
    "figure.facecolor": PAPER_COLOUR,
    "text.color": TEXT_COLOUR,
    "axes.labelcolor": TEXT_COLOUR,
    "axes.edgecolor": NOMINAL_COLOUR,
    "xtick.color": TEXT_COLOUR,
    "ytick.color": TEXT_COLOUR,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.formatter.useoffset": False,
    "axes.axisbelow": True,
    "grid.color": GRID_COLOUR,
    "grid.linewidth": 0.5,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "lines.linewidth": 1.1,
    "svg.hashsalt": "hexdbb",
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
}
"""Settings of matplotlib. Titles stand at one height: to look for what they might cover measures every tick label once
more. Fonts are embedded in PDF whole, so that its text can be searched and copied."""
TICK_FORMULA = "\\mathdefault"
"""Part of the formulas that matplotlib itself makes, for tick labels of powers."""
FINISHED = "_hexdbb_is_finished"
"""Attribute of a figure that is laid out: to look for its texts again takes as long as to draw some of it."""

Arguments = ParamSpec("Arguments")


def sheet(height_in: float) -> Figure:
    """Return an empty figure as wide as a sheet, its height no more than the sheet's."""
    height_in = min(height_in, PAGE_IN[1])
    figure = Figure(figsize=(PAGE_IN[0], height_in), layout="constrained", dpi=PNG_DPI)
    engine = figure.get_layout_engine()
    assert engine is not None  # constrained, as asked for above
    engine.set(rect=(SIDE_MARGIN, 0.0, 1.0 - 2.0 * SIDE_MARGIN, 1.0), w_pad=0.05, h_pad=0.05)  # type: ignore[call-arg]
    return figure


def styled(draw: Callable[Arguments, Figure]) -> Callable[Arguments, Figure]:
    """Let a function draw in this style and return its figure finished."""

    @functools.wraps(draw)
    def drawn(*args: Arguments.args, **kwargs: Arguments.kwargs) -> Figure:
        with mpl.rc_context(STYLE):
            figure = draw(*args, **kwargs)
            finish(figure)
        return figure

    return drawn


def finish(figure: Figure) -> None:
    """Lay a figure out, once, and show names in it as they are; nothing happens to one that is finished."""
    if getattr(figure, FINISHED, False):
        return
    setattr(figure, FINISHED, True)
    engine = figure.get_layout_engine()
    FigureCanvasAgg(figure)
    _show_names_as_they_are(figure)
    if engine is not None:
        engine.execute(figure)
        figure.set_layout_engine("none")


def inside(*drawn: Artist) -> None:
    """State of artists that they lie within their panel: the layout need not measure them, which is slow."""
    for artist in drawn:
        artist.set_in_layout(False)


def all_inside(axes: Axes) -> None:
    """State that all lines and areas of a panel lie within it."""
    inside(*axes.lines, *axes.collections, *axes.patches)


def _show_names_as_they_are(figure: Figure) -> None:
    """Turn off formulas in all texts but tick labels, so that "$" in the name of a record is shown as it is."""
    for text in _texts(figure):
        # Tick labels are empty until they are drawn.
        if text.get_text() and TICK_FORMULA not in text.get_text():
            text.set_parse_math(False)
            text.set_text(printable(text.get_text()))


def _texts(artist: Artist) -> Iterator[Text]:
    """Yield all texts that are drawn; `findobj` would make the ticks of panels that have none first."""
    if isinstance(artist, Text):
        yield artist
    left_out = () if not isinstance(artist, Axes) or artist.axison else (artist.xaxis, artist.yaxis)
    for child in artist.get_children():
        if child not in left_out:
            yield from _texts(child)
