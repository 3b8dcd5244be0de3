"""What pictures of studies share: colours, the grid, axes of sizes, points with their bounds."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.ticker import FixedLocator, FormatStrFormatter, LogLocator, NullLocator
from numpy.typing import ArrayLike

from hexdbb.studies.rates import Bounded

MEASURED, STATED, SECOND, BAD = "#0072B2", "#555555", "#009E73", "#D55E00"
"""Colours of Okabe and Ito (2008), told apart by everybody: found, stated or wanted, a second series, false."""
GRID: dict[str, Any] = {"color": "0.88", "linewidth": 0.6}


def size_axis(axis: Axis, at: Sequence[float] | None = None) -> None:
    """Label a logarithmic axis with plain numbers, at the values given or at 1, 2 and 5 of each decade."""
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)) if at is None else FixedLocator(list(at)))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FormatStrFormatter("%g"))


def error_bars(
    axes: Axes, at: ArrayLike, values: Iterable[Bounded], factor: float, label: str | None, colour: str = MEASURED
) -> None:
    """Draw values with their bounds, times a factor; a bound beyond the cases ends at the value."""
    rows = factor * np.array([[each.value, each.low, each.high] for each in values], dtype=float).reshape(-1, 3)
    rows[:, 1:] = np.where(np.isfinite(rows[:, 1:]), rows[:, 1:], rows[:, :1])
    spread = np.abs(rows[:, 1:] - rows[:, :1]).T
    axes.errorbar(at, rows[:, 0], yerr=spread, fmt="o", color=colour, markersize=4, capsize=3, label=label)
