"""Forms that a function may have: each is fitted by weighted least squares, and explains a part of its variation.

y = constant + linear combination of a few functions of x, of which some have shapes (centre and width of a bump,
period of a sine, begin and width of a dead band) that are searched on a grid and refined (variable projection; Golub
and Pereyra 1973).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import combinations_with_replacement, product

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Basis = Callable[[Floats, Floats], Floats]

FWHM = 2.0 * np.sqrt(2.0 * np.log(2.0))
"""Full width at half height of a Gaussian, in its standard deviations."""
WIDEST = 0.6
"""Width of a bump over the variable's range above which it is no bump but a bend."""
LONGEST = 1.0
"""Period of a sine over the range above which less than a period is seen."""
SHORTEST = 1.0 / 12.0
"""Period of a sine over the range below which a function's splines hardly follow it."""
GRID = 24
"""Starts of a shape: neighbours overlap for the narrowest width that is looked for."""

BAND_ENDS = 13
"""Ends of a dead band that are tried first, a twelfth of the range apart: so are most functions' splines. The search
moves the ends from there."""
FINEST = 1e-6
"""Last step of the search for a shape, over its range: words and drafts state four digits."""
GAINED = 1e-9
"""Part of the variation that another shape must explain besides: where many say the same, rounding alone would move the
search on and on."""


@dataclass(frozen=True)
class Fit:
    """A form fitted: `constant`, coefficients of its functions, shapes, and the part of the variation it explains."""

    kind: str
    constant: float
    coefficients: Floats
    shapes: Floats
    explained: float

    def at(self, x: Floats) -> Floats:
        """Return its values at some places, shape (m,)."""
        found: Floats = self.constant + BASES[self.kind](x, self.shapes) @ self.coefficients
        return found


def _linear(x: Floats, shapes: Floats) -> Floats:
    return x[:, None]


def _step(x: Floats, shapes: Floats) -> Floats:
    return np.sign(x)[:, None]


def _bump(x: Floats, shapes: Floats) -> Floats:
    centre, width = shapes
    found: Floats = np.exp(-0.5 * (FWHM * (x - centre) / width) ** 2)[:, None]
    return found


def _sine(x: Floats, shapes: Floats) -> Floats:
    turn = 2.0 * np.pi * x / shapes[0]
    return np.column_stack([np.sin(turn), np.cos(turn)])


def _dead_band(x: Floats, shapes: Floats) -> Floats:
    low, width = shapes
    return np.column_stack([np.minimum(x - low, 0.0), np.maximum(x - low - width, 0.0)])


BASES: dict[str, Basis] = {"linear": _linear, "step": _step, "sine": _sine, "bump": _bump, "dead band": _dead_band}
"""The functions of every form, the simplest form first."""


def fits(x: Floats, y: Floats, weights: Floats, period: float = 0.0) -> Iterator[Fit]:
    """Yield every form fitted to a function, the simplest first.

    Parameters
    ----------
    x, y, weights : ndarray, shape (m,)
    period : float
        Of the variable, in which whole sines must fit; 0 where it is not periodic.
    """
    low, high = float(x.min()), float(x.max())
    if period:
        best = max((_fitted("sine", x, y, weights, np.array([period / k])) for k in (1, 2, 3)), key=_explained)
        yield best
    else:
        yield _fitted("linear", x, y, weights, np.empty(0))
        if low < 0.0 < high:
            yield _fitted("step", x, y, weights, np.empty(0))
        periods = np.geomspace(SHORTEST, LONGEST, GRID)[:, None] * (high - low)
        yield _searched("sine", x, y, weights, periods, [(SHORTEST * (high - low), LONGEST * (high - low))])
    narrowest, widest = 2.0 * float(np.median(np.diff(x))), WIDEST * (high - low)
    if narrowest < widest:  # a step is told by four points, between which no bump is seen
        widths = np.geomspace(narrowest, widest, 8)
        grid = np.array([(centre, width) for centre in np.linspace(low, high, GRID) for width in widths])
        yield _searched("bump", x, y, weights, grid, [(low, high), (narrowest, widest)])
    if not period:
        ends = np.linspace(low, high, BAND_ENDS)
        bands = np.array([(one, other - one) for one, other in combinations_with_replacement(ends, 2)])
        yield _searched("dead band", x, y, weights, bands, [(low, high), (0.0, high - low)])


def _searched(kind: str, x: Floats, y: Floats, weights: Floats, grid: Floats, bounds: list[tuple[float, float]]) -> Fit:
    """Fit a form from the best shapes of a grid on, by a compass search (Kolda, Lewis and Torczon 2003).

    One or two shapes need no more, and SciPy's optimizers take a third of a second to load.
    """
    best = max((_fitted(kind, x, y, weights, shapes) for shapes in grid), key=_explained)
    lower, upper = np.array(bounds).T
    step, least = (upper - lower) / GRID, FINEST * (upper - lower)
    ways = [np.array(each) for each in product((-1.0, 0.0, 1.0), repeat=len(bounds)) if any(each)]
    while (step > least).any():
        around = (np.clip(best.shapes + way * step, lower, upper) for way in ways)
        other = max((_fitted(kind, x, y, weights, shapes) for shapes in around), key=_explained)
        if other.explained > best.explained + GAINED:
            best = other
        else:
            step = 0.5 * step
    return best


def _fitted(kind: str, x: Floats, y: Floats, weights: Floats, shapes: Floats) -> Fit:
    table = np.column_stack([np.ones(len(x)), BASES[kind](x, shapes)])
    root = np.sqrt(weights)
    coefficients, *_ = np.linalg.lstsq(root[:, None] * table, root * y, rcond=None)
    left = float(np.sum(weights * (y - table @ coefficients) ** 2))
    mean = float(np.average(y, weights=weights))
    whole = float(np.sum(weights * (y - mean) ** 2))
    explained = 1.0 - left / whole if whole > 0.0 else 0.0
    return Fit(kind, float(coefficients[0]), coefficients[1:], shapes, explained)


def _explained(fit: Fit) -> float:
    return fit.explained
