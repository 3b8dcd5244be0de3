"""Axes of charts that have one: ticks at round numbers, grid lines, labels."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.reporting.drawings.svg import element, label

Floats = NDArray[np.float64]

LEFT, RIGHT, TOP, BOTTOM = 42.0, 8.0, 30.0, 30.0
"""Margins of a chart, drawing units: labels of 11 units beside the ticks."""
STEPS = (1.0, 2.0, 5.0, 10.0)


@dataclass(frozen=True)
class Frame:
    """A drawing area and the ranges it shows."""

    width: float
    height: float
    x_range: tuple[float, float]
    y_range: tuple[float, float]

    def x(self, value: Floats | float) -> Floats:
        """Return where values lie across."""
        low, high = self.x_range
        placed: Floats = LEFT + (np.asarray(value) - low) / (high - low) * (self.width - LEFT - RIGHT)
        return placed

    def y(self, value: Floats | float) -> Floats:
        """Return where values lie down."""
        low, high = self.y_range
        placed: Floats = self.height - BOTTOM - (np.asarray(value) - low) / (high - low) * (self.height - TOP - BOTTOM)
        return placed

    @property
    def box(self) -> tuple[float, float, float, float]:
        """View box of the chart."""
        return 0.0, 0.0, self.width, self.height

    def grid(self, x_ticks: Floats, y_ticks: Floats, x_name: str, y_name: str) -> Iterator[str]:
        """Draw grid lines with their numbers and the names of the axes."""
        left, right = LEFT, self.width - RIGHT
        top, bottom = TOP, self.height - BOTTOM
        for tick in y_ticks:
            at = float(self.y(tick))
            yield element("line", x1=left, x2=right, y1=at, y2=at, class_="nominal" if tick == 0.0 else "ring")
            yield label(f"{tick:g}", left - 4.0, at + 4.0, text_anchor="end", class_="tick")
        for tick in x_ticks:
            at = float(self.x(tick))
            yield element("line", x1=at, x2=at, y1=top, y2=bottom, class_="ring")
            yield label(f"{tick:g}", at, bottom + 13.0, text_anchor="middle", class_="tick")
        yield label(x_name, (left + right) / 2.0, self.height - 3.0, text_anchor="middle", class_="axis")
        yield label(y_name, 2.0, 11.0, class_="axis")


def round_ticks(low: float, high: float, most: int = 6) -> Floats:
    """Return round numbers within a range, at most as many."""
    width = max(high - low, 1e-12)
    decade = 10.0 ** math.floor(math.log10(width / most))
    step = next(each for each in STEPS if each * decade * most >= width * (1.0 - 1e-9)) * decade
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    ticks: Floats = np.round(np.arange(first, last + 1) * step, 12) + 0.0
    return ticks


def padded(values: Floats, share: float = 0.06) -> tuple[float, float]:
    """Return the range of finite values with some room, 0 inside."""
    finite = values[np.isfinite(values)]
    low, high = min(0.0, float(finite.min(initial=0.0))), max(0.0, float(finite.max(initial=0.0)))
    room = share * max(high - low, 1e-3)
    return low - room, high + room
