"""Hypotheses whose form is found in the readings: the instants of steps in time, periods that nobody states.

A step shifts once and stays: a loose cup, a gauge that slips, a lost count. Sums from the end of the readings backwards
give the gain of a step at every instant at once; the best is taken, and another beside it, as long as each is worth
more than the choice among all instants. The strongest period comes from a Fourier transform over the variable. What the
choice costs, the log of the average over all that was tried relative to the best, is the hypothesis' log prior.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.criteria import Criteria
from hexdbb.evidence.readings import Linear, Readings
from hexdbb.evidence.thinned import Thinned
from hexdbb.learned import ALL, PAIRS, Learned, periodic, step
from hexdbb.learned.numbered import by_feed
from hexdbb.learned.places import LEVERS
from hexdbb.machine import MachineFile
from hexdbb.predictors.periods import COARSE, FINE, LEAST_TURNS, Grid, strongest_frequency

Floats = NDArray[np.float64]

SCALE_NOISES = 8.0
"""Shortest period of the gauge's scale over the noise of a reading, by which a sine of it loses a quarter of itself."""
SCREW_TURNS = 0.02
"""Turns by which a lead may differ from whole periods and still repeat with the screw: a period is seen to a twentieth
of a turn over all readings, which span three turns of the screw and more."""
FASTEST_HZ = 125.0
"""Highest frequency of what is sought between the readings' instants: mains hum at once and twice the mains' frequency
(100 and 120 Hz); a post that shakes does so at some hertz."""
EVEN, AS_LONG = 0.9, 0.01
"""Part of the intervals between readings that are alike, and by what part, above which nothing is told from what it
would alias to: with two feeds half of them are. Between sweeps, and by a clock that jitters, a tenth may differ."""
OVERTONE = 3
"""Highest overtone that the strongest frequency over a position is taken for: what is narrow within its period has the
second, or the third, as strong as the first. A period in time has as many splines, and swings are nearly sines."""
SHAKING = (("reading", ALL), ("cup", ALL))
"""Places that are sought for it: what hums is in the gauge, and the cup stands on the longest post."""
ONE_FEED = 0.5
"""Part of a swing's amplitude at one feed below which that at another says that the feed makes it: sums over some
sweeps are off by less where the swing is several times the noise."""
EVERY = slice(0, None)
"""All rows."""
ROUNDING = 1e-13
"""Part of the largest of some sums of squares by which rounding may make what is left of them negative: a thousand
times that of a float. Of noise of 0.3 µm it adds a millionth to the prior, of readings without noise it keeps them
positive."""


@dataclass(frozen=True)
class Proposal:
    """A hypothesis and its log prior relative to those that are not chosen by the readings."""

    hypothesis: Learned
    log_prior: float


def proposals(linear: Linear, readings: Readings, thinned: Thinned, criteria: Criteria) -> list[Proposal]:
    """Return the steps and periods of a linearisation that are worth a look."""
    steps = () if "time_s" in readings.state.unmeasured else _steps(linear, readings, thinned, criteria)
    return [*steps, *periods(linear, readings, criteria)]


def _shifting() -> Iterator[tuple[str, int]]:
    """Yield places that may shift, each with its element."""
    for place in ("slider", "leg"):
        for element in range(1, 7):
            yield place, element
    for place in ("lateral", "vertical"):
        for element in range(1, 4):
            yield place, element
    # A guideway shifts along itself with both of its sliders.
    yield from (("slider", pair) for pair in PAIRS.values())
    yield from (("ball", ALL), ("cup", ALL), ("platform", ALL), ("reading", ALL))


def _answers(readings: Readings, place: str, element: int) -> Floats:
    """Return what a push at a place does to the readings, a column for each axis."""
    at = Learned(place, element, step([0.0]))
    machine = readings.state.machine
    axes = [at.pushes(axis, machine) for axis in range(at.components)]
    if place in LEVERS:
        shares = [readings.state[each] for each in LEVERS[place]]
        every = [[(readings.answer(ports), column) for column, ports in axis] for axis in axes]
        of_axes = zip(shares, every, strict=True)
        return np.column_stack([sum(share[:, column] * each for each, column in axis) for share, axis in of_axes])
    # Both carriages of a guideway shift at once.
    return np.column_stack([readings.answer([push for _, ports in each for push in ports]) for each in axes])


def _steps(linear: Linear, readings: Readings, thinned: Thinned, criteria: Criteria) -> list[Proposal]:
    few = thinned.linear(linear)
    few_s = thinned.readings.state["time_s"]
    temper = 1.0 + criteria.temper**2 * max(float(np.mean(linear.residual**2)) - 1.0, 0.0)
    in_time = InTime(few, thinned.readings, criteria)
    scans = [(_Scan(in_time, _answers(thinned.readings, *at), temper, criteria), *at) for at in _shifting()]
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
        whole = _Scan(in_time, _answers(readings, place, element), temper, criteria)
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


def periods(
    linear: Linear,
    readings: Readings,
    criteria: Criteria,
    is_asked_for: Callable[[Learned], bool] = lambda _: True,
    *,
    aslant: bool = False,
) -> Iterator[Proposal]:
    """Yield the strongest periods: of the places of sliders and guideways, the gauge's scale, in time of what shifts.

    A rail waves for both of its carriages, the balls that roll in one carriage lift that alone. The cup stands for the
    ball too, which moves alike.

    Parameters
    ----------
    linear : Linear
    readings : Readings
    criteria : Criteria
    is_asked_for : callable, optional
        Tells of a function, whatever its period, whether it is.
    aslant : bool, optional
        Whether guideways wave sideways and up and down at once, too: not where a search begins, which would fit these
        in the place of others.
    """
    position, time_s = readings.state["sliders_mm"], readings.state["time_s"]
    places = [(place, each) for place in ("slider", "slider_joint") for each in range(1, 7)]
    places += [
        (place, each) for place in ("lateral", "vertical", *(["guideway"] if aslant else [])) for each in range(1, 4)
    ]
    machine = readings.state.machine
    for place, element in places:
        learned = Learned(place, element, periodic("position", 1.0))
        if not is_asked_for(learned):
            continue
        axes = [learned.pushes(axis, machine) for axis in range(learned.components)]
        answers = [np.concatenate([linear.residual * readings.answer(ports) for _, ports in each]) for each in axes]
        values = np.concatenate([position[:, column] for column, _ in axes[0]])
        weighted = np.column_stack(answers)
        found = [*_period(place, element, "position", weighted, values, 1.0 / criteria.shortest_mm, OVERTONE)]
        if place != "slider_joint" or not any(_is_of_screw(each.hypothesis, machine) for each in found[:1]):
            yield from found
    scale_mm, shortest_mm = readings.state["gauge_scale_mm"], SCALE_NOISES * float(np.mean(readings.noise_mm))
    if is_asked_for(Learned("reading", ALL, periodic("scale", 1.0))):
        yield from _period("reading", ALL, "scale", linear.residual, scale_mm, 1.0 / shortest_mm)
    gaps = np.diff(np.unique(time_s))
    if len(gaps) and "time_s" not in readings.state.unmeasured:
        highest = 0.5 / float(np.median(gaps))
        # One carriage that is pushed about across its guideway by a clamp, or a pulse of oil, moves alone. A pump or a
        # counterbalance pulls at the platform, and legs grow and shrink alike in a draught.
        carriages = (("slider_joint", element) for element in range(1, 7))
        for place, element in (*_shifting(), *carriages, ("load", ALL), ("leg", ALL)):
            if place != "ball" and is_asked_for(Learned(place, element, periodic("time", 1.0))):
                answers = _answers(readings, place, element)
                weighted = linear.residual[:, None] * answers
                for found in _period(place, element, "time", weighted, time_s, highest):
                    yield from (found, *_by_feed(found, weighted, answers, readings))


def _by_feed(found: Proposal, weighted: Floats, answers: Floats, readings: Readings) -> Iterator[Proposal]:
    """Yield what repeats in time, otherwise at each feed, where it hardly does at one of them.

    Parameters
    ----------
    found : Proposal
        What repeats alike at all feeds.
    weighted, answers : ndarray, shape (n, axes)
        Residual times what a push does to the readings, and that alone.
    readings : Readings
    """
    time_s, feed, sweep = readings.state["time_s"], readings.groups["feed"], readings.groups["sweep"]
    period_s = found.hypothesis.variable.period
    # Slower than a sweep no motor excites it: what swings in minutes is by chance at one feed or another.
    if min(float(np.ptp(time_s[sweep == each])) for each in np.unique(sweep)) < LEAST_TURNS * period_s:
        return
    wave = np.exp(2j * np.pi * time_s / period_s)[:, None]
    sizes = [
        float(np.linalg.norm(np.sum(weighted[rows] * wave[rows], axis=0) / np.sum(answers[rows] ** 2, axis=0)))
        for rows in (feed == each for each in np.unique(feed))
    ]
    if min(sizes) < ONE_FEED * max(sizes):
        hypothesis = replace(found.hypothesis, variable=by_feed(found.hypothesis.variable))
        yield replace(found, hypothesis=hypothesis)


def vibrations(linear: Linear, readings: Readings) -> Iterator[Proposal]:
    """Yield the strongest period in time of what repeats faster than readings are taken.

    Where they are taken at uneven intervals, or each feed at another, they tell it from what it would alias to; else
    there is none that a longer period would not say as well.

    Parameters
    ----------
    linear : Linear
    readings : Readings
    """
    time_s = readings.state["time_s"]
    gaps = np.diff(np.unique(time_s))
    if not len(gaps) or "time_s" in readings.state.unmeasured:
        return
    usual = float(np.median(gaps))
    if np.mean(np.abs(gaps - usual) <= AS_LONG * usual) > EVEN:
        return
    for place, element in SHAKING:
        answers = _answers(readings, place, element)
        weighted, lowest = linear.residual[:, None] * answers, 0.5 / usual
        for found in _period(place, element, "time", weighted, time_s, FASTEST_HZ, lowest=lowest, grid=COARSE):
            yield from (found, *_by_feed(found, weighted, answers, readings))


def _is_of_screw(learned: Learned, machine: MachineFile) -> bool:
    """Check whether something repeats with each turn of the screw, or with a part of one: it is no carriage's."""
    turns = machine.sliders.screw_lead_mm / learned.variable.period
    return round(turns) >= 1 and abs(turns - round(turns)) < SCREW_TURNS


def _period(
    place: str,
    element: int,
    column: str,
    weighted: Floats,
    values: Floats,
    highest: float,
    overtone: int = 1,
    *,
    lowest: float = 0.0,
    grid: Grid = FINE,
) -> Iterator[Proposal]:
    """Yield what repeats with the strongest frequency, and that of which it may be an overtone, up to such a one."""
    strongest, spread = strongest_frequency(weighted, values, highest, lowest, grid), float(np.ptp(values))
    if strongest is None:
        return
    tried = max(spread * highest, 1.0)
    for number in range(1, overtone + 1):
        frequency = strongest / number
        if number == 1 or frequency * spread >= LEAST_TURNS:
            yield Proposal(Learned(place, element, periodic(column, 1.0 / frequency)), -float(np.log(tried)))
