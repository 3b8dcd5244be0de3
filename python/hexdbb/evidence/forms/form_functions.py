"""Functions that may stand beside an effect: what is the same of them about every fit, and their evidence about one.

An effect's form is asked for about many fits, with the same functions. Their products, and the directions of their
prior, are kept. About one fit their products with the model's own values are taken once, however many sets are weighed.
"""

from __future__ import annotations

import weakref
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import accumulate

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.criteria import Criteria
from hexdbb.evidence.linear.marginal import Marginal, marginal
from hexdbb.evidence.linear.readings import Linear, Readings
from hexdbb.evidence.linear.signatures import Signature, signature_of
from hexdbb.evidence.linear.sums import Sums
from hexdbb.learned import Learned

Floats = NDArray[np.float64]
KEPT = 48
"""Signatures kept in memory, of a megabyte or two each: those of an effect's homes are asked for in every trial."""

KEPT_SQUARES = 8192
"""Products of two of them kept, about ten kilobytes each: they are the same about every fit. An effect at all elements
needs several thousand; with 1024 they were evicted before they were used again, which took a sixth of a search."""

KEPT_SETS = 256
"""Sets of functions kept with the directions of their prior, some tens of kilobytes each, a megabyte for an effect at
all elements: an effect's form asks for twenty about every fit, and some ten effects get several full fits."""

LEAST_PRIOR = 1e-9
"""Mean square over the largest below which a direction of the prior does nothing to the readings but rounding."""


@dataclass(frozen=True, eq=False)
class Functions:
    """Functions side by side, of a mean square of one together.

    Attributes
    ----------
    functions : tuple of Learned
    square : ndarray, shape (k, k)
        W'W.
    ends : list of int
        Row after the last of each function but the last.
    axes, root : ndarray, shapes (k, r), (r,)
        Directions of their prior that do something to the readings, uncorrelated there, and the size of each there.
    """

    functions: tuple[Learned, ...]
    square: Floats
    ends: list[int]
    axes: Floats
    root: Floats

    def seen(self, projected: Floats, least: float, size_mm: float) -> Floats:
        """Return the prior's directions of which the model's own values imitate all but too little: shape (k, r).

        Parameters
        ----------
        projected : ndarray, shape (k, k)
            W'W with the model's own values eliminated.
        least : float
            Part of a direction's mean square that must be left.
        size_mm : float
            Root mean square of the functions together.
        """
        white = self.axes / self.root
        shares, turned = np.linalg.eigh(white.T @ projected @ white)
        # Back in the prior's own scale: a direction's size is what it was before it was whitened.
        own = self.root[:, None] * turned
        seen = shares > least
        axes, _ = np.linalg.qr(own[:, seen]) if seen.any() else (own[:, :0], None)
        found: Floats = (size_mm * self.axes) @ axes
        return found


@dataclass(frozen=True, eq=False)
class Beside:
    """Functions beside an effect: their prior, W'W with and without the model's own values, and their evidence."""

    functions: Functions
    factor: Floats
    projected: Floats
    found: Marginal

    @property
    def coefficients(self) -> tuple[tuple[Learned, Floats], ...]:
        """Coefficients of each function per prior standard deviation at the best size, shape (columns, axes)."""
        parts = np.split(self.factor * self.found.size, self.functions.ends)
        return tuple(zip(self.functions.functions, parts, strict=True))

    @property
    def seen(self) -> float:
        """Part of the functions' mean square that the model's own values do not imitate.

        What the effect itself or geometry could have taken says nothing of the effect's form.
        """
        coefficients = self.found.coefficients
        left, whole = (coefficients @ each @ coefficients for each in (self.projected, self.functions.square))
        return float(left / whole)


class FormFunctions:
    """Functions on some readings; what does not change with the fit is kept.

    Parameters
    ----------
    readings : Readings
    criteria : Criteria
    """

    def __init__(self, readings: Readings, criteria: Criteria) -> None:
        self.readings, self.criteria = readings, criteria
        self.signature = lru_cache(KEPT)(partial(signature_of, readings=readings))
        # Weakly: what is kept would keep this, and this what is kept, until the next collection of garbage.
        own: FormFunctions = weakref.proxy(self)
        self.together = lru_cache(KEPT_SETS)(lambda functions: own._together(functions))
        self._square = lru_cache(KEPT_SQUARES)(lambda one, other: own._product(one, other))
        self._parts = lru_cache(KEPT_SQUARES)(lambda function: own._prior(function))

    def forget(self) -> None:
        """Release what can be made anew."""
        for kept in (self.signature, self.together, self._square, self._parts):
            kept.cache_clear()

    def columns(self, coefficients: Sequence[tuple[Learned, Floats]]) -> Floats:
        """Return what functions do to the readings together, a column for each of their coefficients' columns."""
        return np.asarray(sum(self.signature(each).table @ factor for each, factor in coefficients), np.float64)

    def rms_mm(self, beside: Beside) -> float:
        """Return the root mean square of functions as they were found: of those that push one thing, of their sum.

        Functions of states that go together, as a position and the load there, may undo each other for the most part.
        """
        found = np.split(beside.found.coefficients, beside.functions.ends)
        there: dict[tuple[str, int], list[tuple[Learned, Floats]]] = {}
        for function, coefficients in zip(beside.functions.functions, found, strict=True):
            there.setdefault((function.place, function.element), []).append((function, coefficients))
        return float(np.sqrt(sum(self._mean_square_mm(each) for each in there.values())))

    def _mean_square_mm(self, functions: Sequence[tuple[Learned, Floats]]) -> float:
        """Return the mean square of the sum of functions at one place, over rows and elements."""
        elements, state = functions[0][0].elements, self.readings.state
        spaces = [(self.signature(each).space, found.reshape(each.components, -1)) for each, found in functions]
        total = 0.0
        for element in elements:
            pushed = sum(state.design(space, element) @ coefficients.T for space, coefficients in spaces)
            total += float(np.sum(np.square(pushed)))
        return total / (len(elements) * len(self.readings))

    def _together(self, functions: tuple[Learned, ...]) -> Functions:
        factors = [self._parts(each) for each in functions]
        # Each is as probable as the others to hold the whole.
        factor = diagonal(factors) / np.sqrt(len(functions))
        square = np.concatenate(
            [np.concatenate([self._square(one, other) for other in functions], axis=1) for one in functions]
        )
        values, vectors = np.linalg.eigh(factor.T @ square @ factor)
        kept = values > LEAST_PRIOR * values[-1]
        ends = list(accumulate(len(each) for each in factors))[:-1]
        return Functions(functions, square, ends, factor @ vectors[:, kept], np.sqrt(values[kept]))

    def _product(self, one: Learned, other: Learned) -> Floats:
        found: Floats = self.signature(one).table.T @ self.signature(other).table
        return found

    def _prior(self, function: Learned) -> Floats:
        signature: Signature = self.signature(function)
        return signature.prior_factor(self.criteria.roughness[1] if function.variable.is_smooth else 1.0)


class FormsAboutFit:
    """Evidence of functions beside an effect about one linearisation.

    Parameters
    ----------
    linear : Linear
    kept : FormFunctions
    functions : sequence of Learned
        All that are weighed.
    """

    def __init__(self, linear: Linear, kept: FormFunctions, functions: Sequence[Learned]) -> None:
        self._kept = kept
        sums = Sums(linear, kept.readings, ())
        cross = np.concatenate([sums.cross(kept.signature(each).table)[0] for each in functions])
        self._imitated, self._gradient = sums.whole.imitated(cross)
        ends = list(accumulate((each.size for each in functions), initial=0))
        self._at = {each: np.arange(*span) for each, *span in zip(functions, ends[:-1], ends[1:], strict=True)}

    def beside(self, functions: tuple[Learned, ...], size_mm: float) -> Beside | None:
        """Weigh the evidence for some functions beside an effect; None where nothing of them can be seen.

        Parameters
        ----------
        functions : tuple of Learned
        size_mm : float
            Root mean square of the effect's push.
        """
        criteria, together = self._kept.criteria, self._kept.together(functions)
        at = np.concatenate([self._at[each] for each in functions])
        projected = together.square - self._imitated[np.ix_(at, at)]
        factor = together.seen(projected, criteria.form_visible, size_mm)
        if not factor.shape[1]:
            return None
        grid = np.array(criteria.form_grid)
        weights = np.exp(-0.5 * (grid / criteria.form_sigma) ** 2)  # half-normal
        found = marginal(projected, self._gradient[at], [factor], grid, weights / weights.sum())
        return Beside(together, factor, projected, found)


def diagonal(parts: Sequence[Floats]) -> Floats:
    """Return the matrix with some matrices along its diagonal."""
    width = sum(each.shape[0] for each in parts)
    table, at = np.zeros((width, sum(each.shape[1] for each in parts))), [0, 0]
    for each in parts:
        table[at[0] : at[0] + each.shape[0], at[1] : at[1] + each.shape[1]] = each
        at[0] += each.shape[0]
        at[1] += each.shape[1]
    return table
