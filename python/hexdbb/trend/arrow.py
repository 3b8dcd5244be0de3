"""The linear system of records fitted together: one machine, a set-up for each record, and values that change.

A record's own unknowns w_r = (z_r, v_r), its set-up and its departures, meet those of other records in the shared
values x alone (the machine's, and those of fixings of the cup that several records share), so the system has the form
of an arrow and is reduced to x by Schur complements:
    S = P + sum (H_xx - H_xw A_w^-1 H_wx),  A_w = H_ww + P_w;   a year of daily records costs 365 small systems.
Covariances are those of the whole system; that of x is carried into every w_r.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy import linalg

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]


@dataclass(frozen=True)
class Changing:
    """Values that change from record to record: one element of one effect.

    Attributes
    ----------
    effect, element : str
    columns : tuple of int
        Their places among the model's values.
    scale : float
        Standard deviation of the departures, in the values' prior standard deviations.
    """

    effect: str
    element: str
    columns: tuple[int, ...]
    scale: float = 1.0

    @property
    def label(self) -> str:
        """Name as options and files have it: ``backlash:4``."""
        return f"{self.effect}:{self.element}" if self.element else self.effect


@dataclass(frozen=True, eq=False)
class Equations:
    """Normal equations of one record about the present values, in prior standard deviations.

    Attributes
    ----------
    information : ndarray, shape (size, size)
    gradient : ndarray, shape (size,)
        J'r, r measured minus predicted.
    at : ndarray, shape (size,)
        Present values, from their starts, in prior standard deviations.
    effective_mm : float
        Noise with which readings count: what the model leaves, times the root of its autocorrelation time.
    noise_mm : float
        Of one reading.
    squared_mm2, rms_mm : float
        Sum of the squares of what the model leaves; its root mean square.
    readings : int
    """

    information: Floats
    gradient: Floats
    at: Floats
    effective_mm: float
    noise_mm: float
    squared_mm2: float
    rms_mm: float
    readings: int


@dataclass(frozen=True, eq=False)
class Layout:
    """Which of a record's values are shared, and which are its own.

    Attributes
    ----------
    shared : ndarray of int
        Places of the shared free values in the first record's model: the machine's, and those of fixings of the cup
        that several records share.
    set_up : tuple of ndarray of int
        Places of each record's own free values of the set-up.
    places : tuple of ndarray of int
        Places of the shared values in each record's model: the machine's are the same in all.
    of_fixings : int
        How many of the shared values, the last ones, are those of shared fixings.
    """

    shared: Ints
    set_up: tuple[Ints, ...]
    places: tuple[Ints, ...]
    of_fixings: int = 0


@dataclass(frozen=True, eq=False)
class Solution:
    """The arrow-shaped system solved about the present values.

    Attributes
    ----------
    layout : Layout
    changing : tuple of Changing
    moved : ndarray, shape (shared,)
        Step of the shared values, in prior standard deviations.
    covariance : ndarray, shape (shared, shared)
    own : tuple of ndarray
        Every record's own unknowns: step of the set-up, then of the departures.
    spread : tuple of ndarray
        Their covariances with the shared values held.
    carried : tuple of ndarray
        How a record's own unknowns follow the shared ones: w = ... - carried x.
    log_evidence : float
        Of the readings, up to a constant that no choice of changing values alters.
    """

    layout: Layout
    changing: tuple[Changing, ...]
    moved: Floats
    covariance: Floats
    own: tuple[Floats, ...]
    spread: tuple[Floats, ...]
    carried: tuple[Floats, ...]
    log_evidence: float

    @cached_property
    def departing(self) -> Ints:
        """Places of the changing values."""
        return np.array([column for each in self.changing for column in each.columns], dtype=np.intp)

    def covariance_of(self, record: int) -> Floats:
        """Return the covariance of a record's own unknowns, that of the shared values carried into it."""
        return self.spread[record] + self.carried[record] @ self.covariance @ self.carried[record].T

    def of_departures(self, record: int) -> slice:
        """Return where the departures stand among a record's own unknowns."""
        return slice(len(self.layout.set_up[record]), None)


def solve(
    equations: Sequence[Equations],
    layout: Layout,
    changing: Sequence[Changing],
    departures: Sequence[Floats] | None = None,
    damping: float = 0.0,
) -> Solution:
    """Solve the arrow-shaped system about the present values.

    Parameters
    ----------
    equations : sequence of Equations
        One of each record.
    layout : Layout
    changing : sequence of Changing
    departures : sequence of ndarray, optional
        Present departures of each record, in prior standard deviations, in the order of `changing`; zero where not
        given.
    damping : float
        Information, in that of a prior, that the steps of the set-ups are small.
    """
    columns = np.array([column for each in changing for column in each.columns], dtype=np.intp)
    scales = np.array([each.scale for each in changing for _ in each.columns])
    damped = np.arange(len(layout.shared)) >= len(layout.shared) - layout.of_fixings
    total = np.diag(1.0 + damping * damped)
    downhill = np.zeros(len(layout.shared))
    kept, log_evidence = [], 0.0
    for number, (each, set_up, shared) in enumerate(zip(equations, layout.set_up, layout.places, strict=True)):
        weight = 1.0 / each.effective_mm**2
        own = np.concatenate([set_up, columns])
        departed = np.zeros(len(columns)) if departures is None else departures[number]
        prior = np.concatenate([np.ones(len(set_up)), 1.0 / scales**2])
        inside = weight * each.information[np.ix_(own, own)] + np.diag(prior)
        inside[np.arange(len(set_up)), np.arange(len(set_up))] += damping
        across = weight * each.information[np.ix_(own, shared)]
        down_own = weight * each.gradient[own] - prior * np.concatenate([each.at[set_up], departed])
        # By the triangular factor: the difference below loses what an inverse of this condition is wrong by.
        factor = linalg.cholesky(inside, lower=True)
        half = linalg.solve_triangular(factor, across, lower=True)
        down = linalg.solve_triangular(factor, down_own, lower=True)
        inverse = linalg.cho_solve((factor, True), np.eye(len(own)))
        carried = linalg.solve_triangular(factor, half, lower=True, trans="T")
        total += weight * each.information[np.ix_(shared, shared)] - half.T @ half
        downhill += weight * each.gradient[shared] - half.T @ down
        log_evidence += 0.5 * (down @ down + np.log(prior).sum()) - np.log(np.diag(factor)).sum()
        log_evidence -= 0.5 * float(departed**2 @ (1.0 / scales**2)) if len(columns) else 0.0
        kept.append((inverse, carried, linalg.solve_triangular(factor, down, lower=True, trans="T")))
    # The prior of the shared values counts once; the present values differ from record to record by departures only.
    first_departed = np.zeros(len(columns)) if departures is None else departures[0]
    at = equations[0].at.copy()
    at[columns] -= first_departed
    downhill -= at[layout.shared]
    factor = linalg.cholesky(total, lower=True)
    covariance: Floats = linalg.cho_solve((factor, True), np.eye(len(layout.shared)))
    moved = covariance @ downhill
    log_evidence += 0.5 * float(downhill @ moved) - np.log(np.diag(factor)).sum()
    return Solution(
        layout,
        tuple(changing),
        moved,
        covariance,
        tuple(step - carried @ moved for _, carried, step in kept),
        tuple(inverse for inverse, _, _ in kept),
        tuple(carried for _, carried, _ in kept),
        float(log_evidence),
    )


def cost(
    equations: Sequence[Equations], layout: Layout, changing: Sequence[Changing], departures: Sequence[Floats]
) -> float:
    """Return half of chi-square of all readings and of all departures from the priors."""
    columns = [column for each in changing for column in each.columns]
    scales = np.array([each.scale for each in changing for _ in each.columns])
    shared = equations[0].at.copy()
    shared[columns] -= departures[0]
    total = float(np.sum(shared[layout.shared] ** 2))
    for each, set_up, departed in zip(equations, layout.set_up, departures, strict=True):
        total += each.squared_mm2 / each.effective_mm**2 + float(np.sum(each.at[set_up] ** 2))
        total += float(np.sum((departed / scales) ** 2))
    return 0.5 * total
