"""Many short texts of one style as one artist: numbers in tables, at reversals, on grids.

matplotlib lays out, measures and keeps every `Text` by itself, which takes two thirds of the time that a sheet of
numbers takes to draw. Here a label is placed by the advances of its characters and the height of a digit, both measured
once for a sheet, and handed to the renderer. The same text is written, in the same font.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar
from weakref import WeakKeyDictionary, proxy

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.path import Path
from matplotlib.transforms import Bbox, BboxTransformTo, Transform
from numpy.typing import ArrayLike, NDArray

from hexdbb.charts.colours import PAPER_COLOUR
from hexdbb.files.plain_text import printable

ALONG = {"left": 0.0, "center": 0.5, "right": 1.0}
UP = {"bottom": 0.0, "center": 0.5, "top": 1.0}
"""Parts of a label's length and of a digit's height that lie before its place."""

BACKING_PT = 0.6
"""Paper around a label, points."""


class Labels(Artist):
    """Texts at places of a panel, drawn within or beyond it, for which the layout makes no room.

    Parameters
    ----------
    axes : Axes
        Gets the artist.
    places : array-like, shape (n, 2)
    texts : sequence of str, length n
        One line each; shown as they are, without formulas.
    transform : Transform, optional
        From places to the display; the panel's data without it.
    ha, va : str
        ``left``, ``center`` or ``right``; ``bottom``, ``center`` or ``top``: of the text, or of the sheet's directions
        where it is turned.
    size_pt : float, optional
        The style sheet's without it.
    upright : bool
        Turned by 90 deg, to be read from the right.
    backing : float
        Opacity of paper behind each label, which lets it be read on lines; 0 for none.
    """

    def __init__(
        self,
        axes: Axes,
        places: ArrayLike,
        texts: Sequence[str],
        *,
        color: Any,
        transform: Transform | None = None,
        ha: str = "center",
        va: str = "center",
        fontweight: str = "normal",
        size_pt: float | None = None,
        upright: bool = False,
        backing: float = 0.0,
        zorder: float = 6.0,
    ) -> None:
        super().__init__()
        self.places = np.asarray(places, dtype=np.float64).reshape(-1, 2)
        self.texts = [printable(text) for text in texts]
        self.font = FontProperties(weight=fontweight, size=size_pt)
        self._color, self._upright, self._backing = to_rgba(color), upright, backing
        self._along, self._up = (UP[va], 1.0 - ALONG[ha]) if upright else (ALONG[ha], UP[va])
        self.set_zorder(zorder)
        self.set_in_layout(False)
        axes.add_artist(self)
        self.set_clip_on(False)
        self.set_transform(transform or axes.transData)

    def draw(self, renderer: Any) -> None:
        """Write every label."""
        if not self.get_visible():
            return
        if self._backing:
            self._draw_backing(renderer)
        gc = renderer.new_gc()
        gc.set_foreground(self._color, isRGBA=True)
        from_above = renderer.get_canvas_width_height()[1] if renderer.flipy() else None
        for text, (x, y) in zip(self.texts, self._begins(renderer), strict=True):
            if text:
                down = y if from_above is None else from_above - y
                renderer.draw_text(gc, x, down, text, self.font, 90.0 if self._upright else 0.0)
        gc.restore()
        self.stale = False

    def _draw_backing(self, renderer: Any) -> None:
        gc = renderer.new_gc()
        gc.set_linewidth(0.0)
        paper = to_rgba(PAPER_COLOUR, self._backing)
        margin = renderer.points_to_pixels(BACKING_PT)
        for box in self.boxes(renderer):
            renderer.draw_path(gc, Path.unit_rectangle(), BboxTransformTo(box.padded(margin)), paper)
        gc.restore()

    def get_window_extent(self, renderer: Any = None) -> Bbox:
        """Return what the labels cover, pixels."""
        return Bbox.union(self.boxes(renderer))

    def boxes(self, renderer: Any = None) -> list[Bbox]:
        """Return what each label covers, pixels."""
        figure: Any = self.get_figure(root=True)
        renderer = renderer or figure.canvas.get_renderer()
        measured = _Measured.by(renderer, self.font)
        height = measured.digit_height
        boxes = []
        for text, (x, y) in zip(self.texts, self._begins(renderer), strict=True):
            length = measured.length(text)
            boxes.append(
                Bbox([[x - height, y], [x, y + length]] if self._upright else [[x, y], [x + length, y + height]])
            )
        return boxes

    def _begins(self, renderer: Any) -> NDArray[np.float64]:
        """Return where the baseline of each label begins, pixels, shape (n, 2)."""
        measured = _Measured.by(renderer, self.font)
        along = np.array([self._along and self._along * measured.length(text) for text in self.texts])
        up = np.full(len(along), self._up * measured.digit_height)
        begins = np.asarray(self.get_transform().transform(self.places), dtype=np.float64)
        offsets: NDArray[np.float64] = np.column_stack([up, -along] if self._upright else [-along, -up])
        return begins + offsets


def longest_in(figure: Figure, texts: Sequence[str]) -> float:
    """Return the length of the longest of some texts in the style sheet's size, inches."""
    canvas: Any = FigureCanvasAgg(figure)
    measured = _Measured.by(canvas.get_renderer(), FontProperties())
    return max(map(measured.length, texts), default=0.0) / figure.get_dpi()


class _Measured:
    """Sizes of characters as a renderer writes them in a font, pixels; each is measured once."""

    _all: ClassVar[WeakKeyDictionary[Any, dict[tuple[Any, float], _Measured]]] = WeakKeyDictionary()

    def __init__(self, renderer: Any, font: FontProperties) -> None:
        self.digit_height = float(renderer.get_text_width_height_descent("0", font, False)[1])
        self._digits = float(renderer.get_text_width_height_descent("00", font, False)[0])
        self._advances: dict[str, float] = {}
        self._renderer, self._font = proxy(renderer), font

    @classmethod
    def by(cls, renderer: Any, font: FontProperties) -> _Measured:
        fonts = cls._all.setdefault(renderer, {})
        key = (font.get_weight(), font.get_size())
        if key not in fonts:
            fonts[key] = cls(renderer, font)
        return fonts[key]

    def length(self, text: str) -> float:
        """Return the length of a text as the sum of its characters' advances: kerning is left out."""
        return sum(map(self._advance, text))

    def _advance(self, character: str) -> float:
        if character not in self._advances:
            # Between digits, so that white beside a character counts.
            between, _, _ = self._renderer.get_text_width_height_descent(f"0{character}0", self._font, False)
            self._advances[character] = float(between) - self._digits
        return self._advances[character]
