"""Periods that nobody states, proposed by the readings: of positions, of the gauge's scale, of time.

The strongest period comes from a Fourier transform over the variable. What the choice costs, the log of the number of
those that were tried, is the hypothesis' log prior.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.criteria import Criteria
from hexdbb.evidence.linear.readings import Linear, Readings
from hexdbb.evidence.proposals.proposed import Proposal, answers_at, shifting
from hexdbb.learned import ALL, Learned, periodic
from hexdbb.learned.repeating import by_feed
from hexdbb.machine import MachineFile
from hexdbb.predictors.periods import COARSE, FINE, LEAST_TURNS, Grid, strongest_frequency
from hexdbb.samples.distinct import distinct_rows

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
        for place, element in (*shifting(), *carriages, ("load", ALL), ("leg", ALL)):
            if place != "ball" and is_asked_for(Learned(place, element, periodic("time", 1.0))):
                yield from _in_time(place, element, linear, readings, highest)


def _in_time(
    place: str,
    element: int,
    linear: Linear,
    readings: Readings,
    highest: float,
    *,
    lowest: float = 0.0,
    grid: Grid = FINE,
) -> Iterator[Proposal]:
    """Yield what repeats in time at a place with the strongest frequency, alike at all feeds and otherwise at each."""
    answers = answers_at(readings, place, element)
    weighted = linear.residual[:, None] * answers
    for found in _period(place, element, "time", weighted, readings.state["time_s"], highest, lowest=lowest, grid=grid):
        yield found
        yield from _by_feed(found, weighted, answers, readings)


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
    time_s, feed = readings.state["time_s"], readings.groups["feed"]
    period_s = found.hypothesis.variable.period
    first, sweep = distinct_rows(feed, readings.groups["sweep"])
    begins, ends = np.full(len(first), np.inf), np.full(len(first), -np.inf)
    np.minimum.at(begins, sweep, time_s)
    np.maximum.at(ends, sweep, time_s)
    # Slower than a sweep no motor excites it: what swings in minutes is by chance at one feed or another.
    if float(np.min(ends - begins)) < LEAST_TURNS * period_s:
        return
    phase = 2.0 * np.pi * time_s / period_s
    # Sweep by sweep: over all of them a frequency that is a little off is out of step.
    cosines, sines, squares = (
        np.stack([np.bincount(sweep, each) for each in columns.T])
        for columns in (weighted * np.cos(phase)[:, None], weighted * np.sin(phase)[:, None], answers**2)
    )
    waves, of = np.hypot(cosines, sines), feed[first]
    sizes = [
        float(np.linalg.norm(waves[:, of == each].sum(axis=1) / squares[:, of == each].sum(axis=1)))
        for each in np.unique(of)
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
        yield from _in_time(place, element, linear, readings, FASTEST_HZ, lowest=0.5 / usual, grid=COARSE)


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
