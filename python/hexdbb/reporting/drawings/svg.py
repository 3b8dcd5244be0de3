"""SVG elements as text; every text and attribute is escaped here, and nowhere else."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def element(name: str, /, *inside: str, **attributes: object) -> str:
    """Return an element; ``stroke_width`` becomes ``stroke-width``, ``class_`` becomes ``class``; None is left out."""
    said = "".join(
        f' {key.rstrip("_").replace("_", "-")}="{escape(_shown(value))}"'
        for key, value in attributes.items()
        if value is not None
    )
    return f"<{name}{said}>{''.join(inside)}</{name}>"


def label(words: str, x: float, y: float, **attributes: object) -> str:
    """Return a text."""
    return element("text", escape(words), x=x, y=y, **attributes)


def path(x: Floats, y: Floats, **attributes: object) -> str:
    """Return a line through points; it breaks where one is not finite."""
    return element("path", d=" ".join(_steps(x, y)), fill="none", **attributes)


def chart(title: str, box: tuple[float, float, float, float], inside: Iterable[str], **attributes: object) -> str:
    """Return a chart with a title that a screen reader tells."""
    view = " ".join(f"{each:g}" for each in box)
    return element("svg", element("title", escape(title)), *inside, viewBox=view, role="img", **attributes)


def _steps(x: Floats, y: Floats) -> Iterable[str]:
    pen = "M"
    for across, down in zip(x.tolist(), y.tolist(), strict=True):
        if across == across and down == down:
            yield f"{pen}{across:.2f},{down:.2f}"
            pen = "L"
        else:
            pen = "M"


def _shown(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
