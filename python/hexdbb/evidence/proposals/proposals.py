"""Hypotheses whose form is found in the readings: the instants of steps in time, periods that nobody states.

A step shifts once and stays: a loose cup, a gauge that slips, a lost count. Sums from the end of the readings backwards
give the gain of a step at every instant at once; the best is taken, and another beside it, as long as each is worth
more than the choice among all instants. What the choice costs, the log of the average over all that was tried relative
to the best, is the hypothesis' log prior. Periods stand in `periods.py`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.criteria import Criteria
from hexdbb.evidence.linear.readings import Linear, Readings
from hexdbb.evidence.linear.thinned import Thinned
from hexdbb.evidence.proposals.periods import periods
from hexdbb.evidence.proposals.proposed import Proposal, answers_at, shifting
from hexdbb.learned import Learned, step

Floats = NDArray[np.float64]

EVERY = slice(0, None)
"""All rows."""
ROUNDING = 1e-13
"""Part of the largest of some sums of squares by which rounding may make what is left of them negative: a thousand
times that of a float. Of noise of 0.3 µm it adds a millionth to the prior, of readings without noise it keeps them
positive."""


def proposals(linear: Linear, readings: Readings, thinned: Thinned, criteria: Criteria) -> list[Proposal]:
    """Return the steps and periods of a linearisation that are worth a look."""
    steps = () if "time_s" in readings.state.unmeasured else _steps(linear, readings, thinned, criteria)
    return [*steps, *periods(linear, readings, criteria)]


def _steps(linear: Linear, readings: Readings, thinned: Thinned, criteria: Criteria) -> list[Proposal]:
    few = thinned.linear(linear)
    few_s = thinned.readings.state["time_s"]
    temper = 1.0 + criteria.temper**2 * max(float(np.mean(linear.residual**2)) - 1.0, 0.0)
    in_time = InTime(few, thinned.readings, criteria)
    scans = [(_Scan(in_time, answers_at(thinned.readings, *at), temper, criteria), *at) for at in shifting()]
    # One step tells which places shift; a second and further ones are sought at the best of them only.
    scans = sorted(scans, key=lambda each: -each[0].gains([]).max())[: criteria.full_fits]
    found = []
    for scan, place, element in scans:
        instants, log_prior, gain = scan.greedy(criteria.most_steps // scan.pushes.shape[1], criteria.detect_nats)
        if instants:
            found.append((gain + log_prior, place, element, instants, log_prior))
    if not found:
        return []
    found.sort(key=lambda each: -each[0])
    chosen, in_time = [], InTime(linear, readings, criteria)
    for _, place, element, instants, log_prior in found:
        whole = _Scan(in_time, answers_at(readings, place, element), temper, criteria)
        refined = whole.refined(instants, float(np.median(np.diff(np.unique(few_s)))))
        chosen.append(Proposal(Learned(place, element, step(refined)), log_prior))
    return chosen


class InTime:
    """Rows in order of time, the model's own values eliminated: white columns J L^-T of L L' = J'J + I."""

    def __init__(self, linear: Linear, readings: Readings, criteria: Criteria) -> None:
        time_s, circle = readings.state["time_s"], readings.groups["circle"]
        self.order = np.argsort(time_s, kind="stable")
        changes = np.flatnonzero(np.diff(circle[self.order]))
        every = np.arange(len(self.order))
        reach = criteria.change_part * len(self.order) / (len(changes) + 1.0)
        self.at_change = np.abs(every[:, None] - changes - 1).min(axis=1, initial=len(self.order)) <= reach
        """Rows at which one circle follows another."""
        self.time_s, self.residual = time_s[self.order], linear.residual[self.order]
        information = linear.normal[:-1, :-1] + np.eye(linear.own.shape[1])
        inverse = np.linalg.inv(np.linalg.cholesky(information))
        self.white = linear.own[self.order] @ inverse.T
        self.fitted = inverse @ (linear.normal[:-1, -1] - linear.standing)


class _Scan:
    """Gain of a step at every instant.

    Parameters
    ----------
    rows : InTime
    pushes : ndarray, shape (n, c)
        Of what shifts, in the readings' order.
    temper : float
        Variance that stands for the noise's one.
    criteria : Criteria
    """

    def __init__(self, rows: InTime, pushes: Floats, temper: float, criteria: Criteria) -> None:
        self.step_mm = criteria.step_mm
        self.of, self.pushes, self.temper = rows, pushes[rows.order], temper
        self.at_change, self.time_s = rows.at_change, rows.time_s
        # What the model leaves of steps is positive, but for rounding where noise is far below what they push.
        self._least = ROUNDING * float(np.max(np.sum(self.pushes**2, axis=0)))
        self._alone: tuple[Floats, Floats] | None = None

    def gains(self, instants: list[float], rows: slice = EVERY) -> Floats:
        """Return the log likelihood that a step gains beside steps found already, by the row from which it holds.

        Parameters
        ----------
        instants : list of float
        rows : slice
            Rows asked for, shape (m,) of them; the sums of those behind are taken once.
        """
        information, gradient = self._beside_none(rows)
        if instants:
            white, fitted = self._white(instants)
            half = self._behind(white, rows)
            information = information - np.matmul(half, half.transpose(0, 2, 1))
            gradient = gradient - half @ fitted
        known = information + np.eye(self.pushes.shape[1]) * (self.step_mm**-2 + self._least)
        gain: Floats = 0.5 * np.einsum("ni,ni->n", gradient, np.linalg.solve(known, gradient[..., None])[..., 0])
        # Rows of one instant step together: a step begins at the first of them.
        first = np.concatenate([[False], np.diff(self.time_s) > 0.0])[rows]
        return np.where(first, gain / self.temper, -np.inf)

    def _beside_none(self, rows: slice) -> tuple[Floats, Floats]:
        """Return A (m, c, c) and b (m, c) of a step from every row on; those of all rows are taken once."""
        if rows == EVERY and self._alone is not None:
            return self._alone
        half = self._behind(self.of.white, rows)
        sums = self._behind(np.column_stack([self.pushes, self.of.residual]), rows)
        found = sums[:, :, :-1] - np.matmul(half, half.transpose(0, 2, 1)), sums[:, :, -1] - half @ self.of.fitted
        if rows == EVERY:
            self._alone = found
        return found

    def _white(self, instants: list[float]) -> tuple[Floats, Floats]:
        """Return the white columns of steps beside the model's own, and what the readings say of them."""
        steps = np.hstack([self.pushes * (self.time_s >= at)[:, None] * self.step_mm for at in instants])
        cross = self.of.white.T @ steps
        least = 1.0 + self._least * self.step_mm**2
        factor = np.linalg.cholesky(steps.T @ steps + least * np.eye(steps.shape[1]) - cross.T @ cross)
        inverse = np.linalg.inv(factor)
        white: Floats = (steps - self.of.white @ cross) @ inverse.T
        fitted: Floats = inverse @ (steps.T @ self.of.residual - cross.T @ self.of.fitted)
        return white, fitted

    def _behind(self, columns: Floats, rows: slice) -> Floats:
        """Return the sums of pushes times columns from each of some rows on, shape (m, c, columns)."""
        behind = slice(rows.stop, None) if rows.stop is not None else slice(0, 0)
        sums = np.cumsum((self.pushes[rows, :, None] * columns[rows, None, :])[::-1], axis=0)[::-1]
        found: Floats = sums + self.pushes[behind].T @ columns[behind]
        return found

    def greedy(self, most: int, worth: float) -> tuple[list[float], float, float]:
        """Return instants, the log prior of their choice, and the gain of all."""
        instants: list[float] = []
        log_prior = total = 0.0
        # Its values' own priors are counted where it is fitted; until then as Schwarz (1978) does.
        worth += 0.5 * self.pushes.shape[1] * float(np.log(len(self.time_s)))
        for _ in range(most):
            gains = self.gains(instants)
            if instants and self.at_change[np.searchsorted(self.time_s, instants)].any():
                # A constant for each circle is no step in time: what differs from circle to circle is the posture.
                gains[self.at_change] = -np.inf
            best = int(np.argmax(gains))
            spread = float(np.logaddexp.reduce(gains)) - float(np.log(np.isfinite(gains).sum())) - float(gains[best])
            if gains[best] + spread < worth:
                break
            instants.append(float(self.time_s[best]))
            log_prior += spread
            total += float(gains[best])
        return instants, log_prior, total

    def refined(self, instants: list[float], window_s: float) -> list[float]:
        """Return the best instants near some found on fewer rows."""
        found = list(instants)
        for place, at in enumerate(instants):
            near = slice(*np.searchsorted(self.time_s, [at - 2.0 * window_s, at + 2.0 * window_s]))
            gains = self.gains([each for other, each in enumerate(found) if other != place], near)
            if np.isfinite(gains).any():
                found[place] = float(self.time_s[near][int(np.argmax(gains))])
        return found
