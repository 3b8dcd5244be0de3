"""Pictures as files: PNG and SVG of one figure, one PDF of many."""

from __future__ import annotations

import gc
import io
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

import matplotlib as mpl
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from hexdbb.files.atomic_file import replacing, require_folder
from hexdbb.plots.style import PNG_DPI, STYLE, finish

FREED_TOGETHER = 16
"""Sheets of a PDF after which their objects are freed, of some 5 MB a sheet: to free those of each takes a sixth of the
time of drawing."""
PNG_LEVEL = 3
"""Compression of PNG, 1 to 9: two thirds of the default's time (6), and files of pages no larger."""


def _png(figure: Figure, file: BinaryIO) -> None:
    figure.set_dpi(PNG_DPI)
    canvas: Any = FigureCanvasAgg(figure)
    canvas.print_png(file, pil_kwargs={"compress_level": PNG_LEVEL})


CLIP_PATH = re.compile(rb"\bp[0-9a-f]{10}\b")
"""Names of clip paths in an SVG: hashes of addresses in memory."""


def _svg(figure: Figure, file: BinaryIO) -> None:
    from matplotlib.backends.backend_svg import FigureCanvasSVG  # only who writes SVG loads it

    canvas: Any = FigureCanvasSVG(figure)
    drawn = io.BytesIO()
    canvas.print_svg(drawn, metadata={"Date": None})
    # Numbered as they come, so that the same figure gives the same bytes.
    numbers: dict[bytes, bytes] = {}
    text = drawn.getvalue()
    for name in CLIP_PATH.findall(text):
        numbers.setdefault(name, b"clip%d" % len(numbers))
    file.write(CLIP_PATH.sub(lambda found: numbers[found[0]], text))


FORMATS: dict[str, Callable[[Figure, BinaryIO], None]] = {".png": _png, ".svg": _svg}
"""Suffix of a picture's file to the function that writes it: `savefig` would draw every figure twice."""


@dataclass(frozen=True)
class Page:
    """One picture: `suffix` to add to the files' stem, and the function that draws it."""

    suffix: str
    draw: Callable[[], Figure]


def save_figure(figure: Figure, stem: Path, suffixes: Sequence[str] = tuple(FORMATS)) -> list[Path]:
    """Write a figure as STEM.png and STEM.svg, or those of the suffixes named; the same figure gives the same bytes.

    Raises
    ------
    RunError
        A file cannot be written; what stood in its place is untouched.
    """
    written = []
    with mpl.rc_context(STYLE):
        finish(figure)
        for suffix in suffixes:
            drawn = io.BytesIO()
            FORMATS[suffix](figure, drawn)
            written.append(_write(stem.with_name(stem.name + suffix), drawn.getvalue()))
    return written


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


def save_pdf(figures: Iterable[Figure], path: Path) -> Path:
    """Write figures as the sheets of one PDF; they may be drawn one by one. The same figures give the same bytes.

    Raises
    ------
    RunError
        The file cannot be written; what stood in its place is untouched.
    """
    from matplotlib.backends.backend_pdf import FigureCanvasPdf, PdfPages  # loads fontTools: a tenth of a second

    drawn = io.BytesIO()
    with _garbage_left(), mpl.rc_context(STYLE), PdfPages(drawn, metadata={"CreationDate": None}) as sheets:
        for number, figure in enumerate(figures, start=1):
            finish(figure)
            canvas: Any = FigureCanvasPdf(figure)
            canvas.print_pdf(sheets)
            if number % FREED_TOGETHER == 0:
                gc.collect()
    return _write(path, drawn.getvalue())


@contextmanager
def _garbage_left() -> Iterator[None]:
    """Look for no garbage by itself, nor among what was there before: a sheet has a hundred thousand objects.

    Most are garbage when the sheet is written, and none before.
    """
    enabled = gc.isenabled()
    gc.disable()
    gc.freeze()
    try:
        yield
    finally:
        gc.unfreeze()
        if enabled:
            gc.enable()


def _write(path: Path, content: bytes) -> Path:
    with replacing(path) as temporary:
        temporary.write_bytes(content)
    return path
