"""Two states of what snaps over where a variable rises to one number, and back where it falls to a lower one.

A seat that is split, a spring that buckles, a stud loose in its hole: no function of the variable says them, since
between the two numbers both states occur. All pairs of some levels of each variable are tried at once, to first order;
around the best pair finer levels are, on all rows. What the choice costs, the log of the average over all pairs
relative to the best, is the hypothesis' log prior.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.criteria import Criteria
from hexdbb.evidence.linear.readings import Linear, Readings
from hexdbb.evidence.linear.thinned import Thinned
from hexdbb.evidence.proposals.proposals import InTime
from hexdbb.evidence.proposals.proposed import Proposal
from hexdbb.learned import ALL, Learned, is_directed, two_states
from hexdbb.learned.directed import HALF_TURN_DEG
from hexdbb.learned.further import DIRECTIONS_DEG, RELAYS
from hexdbb.learned.numbered import number_of
from hexdbb.learned.places import elements_by_name
from hexdbb.samples.two_states import two_states as states_of

Floats = NDArray[np.float64]
Pair = tuple[float, float]
"""Lower and higher number."""

LEVELS = 12
"""Levels of a variable that are tried first, evenly between its extremes: of a state they place the ends to a 26th
of the range, by which a relay that is right explains nine tenths."""
NEAR = 0.7
"""Part of what the best pair of all is worth that another must be worth to get finer levels, by which it may gain a
tenth."""
ROUNDS, FINER, EITHER_SIDE = 7, 2, 3
"""Rounds about the best pair, how much finer the levels of each are, and how many are tried on either side of each of
its numbers: one and a half of the distance before, since a gain with so many jumps has more than one maximum. In the
end they are a thousandth of the range apart, less than what a variable changes from one reading to the next."""
FINEST_DEG = 1.0
"""Steps of a direction end at it or below: readings of a lap are about as far apart, and tell nothing finer."""


def relays(linear: Linear, readings: Readings, criteria: Criteria) -> list[Proposal]:
    """Return the hypotheses of two states that are worth a look.

    Parameters
    ----------
    linear : Linear
        About what is found already.
    readings : Readings
    criteria : Criteria
        Has the number of rows on which all pairs of levels are tried (`fewest_rows`).
    """
    if "time_s" in readings.state.unmeasured:
        return []
    thinned = Thinned(readings, criteria.fewest_rows)
    few = _Rows(thinned.linear(linear), thinned.readings, criteria)
    tried = [(few.best_of_all(each), each) for each in _all() if not each.variable.needs & readings.state.unmeasured]
    worth = sorted((each for each in tried if each[0].worth > criteria.detect_nats), key=lambda each: -each[0].worth)
    whole, found = _Rows(linear, readings, criteria), []
    for best, of in _one_direction_each(worth)[: criteria.full_fits]:
        if best.worth < NEAR * worth[0][0].worth:
            break
        of, pair = few.turned(of, best.pair) if is_directed(of.variable) else (of, best.pair)
        gain, pair = whole.refined(of, pair)
        found.append((gain, Proposal(replace(of, variable=two_states(of.variable, *pair)), best.log_prior)))
    return [each for _, each in sorted(found, key=lambda each: -each[0])]


def _all() -> Iterator[Learned]:
    """Yield functions of what may have two states, at all elements."""
    for place, variables in RELAYS.items():
        elements = [each for each in elements_by_name(place).values() if each in range(1, 7)] or [ALL]
        for variable in variables:
            yield from (Learned(place, element, variable) for element in elements)


def _one_direction_each(ranked: Sequence[tuple[_Best, Learned]]) -> list[tuple[_Best, Learned]]:
    """Return, of several directions of a vector at a place, the best one; all else as it was."""
    first: dict[tuple[str, str], tuple[_Best, Learned]] = {}
    for each in ranked:
        of = each[1]
        first.setdefault((of.place, of.variable.unit) if is_directed(of.variable) else (of.name, ""), each)
    return list(first.values())


class _Best(NamedTuple):
    """What a pair of levels gains less what its values and its choice cost, the latter, and the pair."""

    worth: float
    log_prior: float
    pair: Pair


class _Rows:
    """Rows in order of time, the model's own values eliminated."""

    def __init__(self, linear: Linear, readings: Readings, criteria: Criteria) -> None:
        self._readings, self._step_mm = readings, criteria.step_mm
        self._in_time = InTime(linear, readings, criteria)
        self._temper = 1.0 + criteria.temper**2 * max(float(np.mean(linear.residual**2)) - 1.0, 0.0)

    def best_of_all(self, of: Learned) -> _Best:
        """Return the best pair of levels of a variable."""
        values = self._values(of)
        levels = np.linspace(values.min(), values.max(), LEVELS + 2)[1:-1]
        low, high = (levels[each] for each in np.triu_indices(LEVELS, 1))
        gains = self._gains(of, low, high)
        best = int(np.argmax(gains))
        spread = float(np.logaddexp.reduce(gains)) - float(np.log(len(gains))) - float(gains[best])
        cost = 0.5 * of.components * float(np.log(len(values)))  # Schwarz (1978), as of steps
        return _Best(float(gains[best]) + spread - cost, spread, (float(low[best]), float(high[best])))

    def refined(self, of: Learned, pair: Pair) -> tuple[float, Pair]:
        """Return what the best pair of finer levels about one gains, and the pair."""
        gain = 0.0
        step = float(np.ptp(self._values(of))) / (LEVELS + 1)
        for _ in range(ROUNDS):
            step /= FINER
            offsets = step * np.arange(-EITHER_SIDE, EITHER_SIDE + 1)
            low, high = (each.ravel() for each in np.meshgrid(pair[0] + offsets, pair[1] + offsets))
            low, high = low[low < high], high[low < high]
            gains = self._gains(of, low, high)
            best = int(np.argmax(gains))
            gain, pair = float(gains[best]), (float(low[best]), float(high[best]))
        return gain, pair

    def turned(self, of: Learned, pair: Pair) -> tuple[Learned, Pair]:
        """Return the best direction about that of a vector's part, and the best pair of levels there."""
        step, gain = DIRECTIONS_DEG[0], self.refined(of, pair)[0]
        while step > FINEST_DEG:
            step /= FINER
            about = number_of(of.variable)
            for turn in (-step, step):
                other = of.with_number((about + turn) % HALF_TURN_DEG or HALF_TURN_DEG)
                # Beyond half a turn the same part has the other sign.
                begun = pair if 0.0 < about + turn <= HALF_TURN_DEG else (-pair[1], -pair[0])
                other_gain, other_pair = self.refined(other, begun)
                if other_gain > gain:
                    gain, of, pair = other_gain, other, other_pair
        return of, pair

    def _values(self, of: Learned) -> Floats:
        values = self._readings.state[of.variable.column][self._in_time.order]
        found: Floats = values if values.ndim == 1 else values[:, of.element - 1]
        return found

    def _gains(self, of: Learned, low: Floats, high: Floats) -> Floats:
        """Return the log likelihood that two states gain, by pairs of levels, shape (m,)."""
        states = states_of(self._values(of)[:, None], low, high)
        axes = [of.pushes(axis, self._readings.state.machine) for axis in range(of.components)]
        answers = (self._readings.answer([push for _, ports in each for push in ports]) for each in axes)
        pushes = np.stack([each[self._in_time.order] for each in answers])
        half = np.stack([(self._in_time.white * each[:, None]).T @ states for each in pushes])  # (axes, k, m)
        gradient = (pushes * self._in_time.residual) @ states - np.tensordot(half, self._in_time.fitted, axes=(1, 0))
        # The square of a state is one, but where neither number is reached.
        square = (pushes[:, None, :] * pushes[None, :, :]) @ np.abs(states)
        information = (square - np.einsum("akm,bkm->abm", half, half)).transpose(2, 0, 1)
        known = information + np.eye(len(axes)) / self._step_mm**2
        solved = np.linalg.solve(known, gradient.T[:, :, None])[:, :, 0]
        gains: Floats = 0.5 * np.einsum("am,ma->m", gradient, solved) / self._temper
        return gains
