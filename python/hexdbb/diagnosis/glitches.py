"""Readings that stand alone: glitches of the gauge or its line, which no model of a machine is asked to explain.

A reading stands alone where what a model leaves differs from the median of its neighbours by far more than noise, and
than such differences are elsewhere on its sweep. An error of the machine has neighbours, or comes again at the same
angle of the same circle in another lap or direction, more often than glitches meet by chance; where there is one lap
only, it may show once, at a drive's reversal. Where many readings stand alone they are the noise, and none is a glitch.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.samples import Samples

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

NEIGHBOURS = 3
"""Readings to each side whose median is expected: a step between two of them stays a step, and three readings off
together are the machine's."""
DENSE_RAD = np.radians(6.0)
"""Angle between readings up to which neighbours say what to expect: a contour of eight harmonics bends within 45
degrees, and three neighbours to each side span 36 then."""
ALONE = 6.0
"""Standard deviations from that median beyond which a reading is off: one in 10^8 of normal noise."""
AGAIN = 3.0
"""Standard deviations from the middle of its two neighbours at which a reading is looked at, and another of the same
place is off too: one in 370 of normal noise, of which the next question leaves none."""
ALIKE = 0.2
"""Part of what a reading is off by that another of the same place must be off by: of a peak one reading wide the
nearest reading of another lap has half. Of 130 glitches of 11,500 readings ten had noise, or the neighbours of another
glitch, at their place in another lap."""
SAME_PLACE_RAD = np.radians(1.0)
"""Angle within which two readings of a circle are of one place: two or three readings of a usual lap; at slower rates
as far as neighbours are apart, but for spikes at reversals, which are shorter than that."""
REVERSAL_S = 0.2
"""Time about a drive's reversal in which it may cross its play, or jump, from one reading to the next."""
SELDOM = 0.25
"""Part of a drive's other reversals up to which something shows at none of them: a sample may miss what is shorter than
the time between two, but not three times of four; glitches show at one in some hundreds."""
FEW_REVERSALS = 4
"""Fewest other reversals that say so: of three, one that a sample missed would decide."""
JUMP = 1.5
"""Distance from the median over the jump of the prediction at a reversal up to which a reading was taken meanwhile: it
lies between where it was and where it will be, but for noise, and what the median takes of either."""
CHANCE = 0.05
"""Probability of as many meetings of two glitches in two laps, below which they are the machine's: one meeting among
few glitches is."""
HOPELESS = 0.1
"""Part of the readings from which on none is looked at twice."""
MOST = 0.02
"""Part of the readings from which on they are no exceptions: gauges glitch once in some hundreds at worst."""


def glitches_in(samples: Samples, residual_mm: Floats, noise_mm: float) -> Mask:
    """Find readings that stand alone.

    Parameters
    ----------
    samples : Samples
    residual_mm : ndarray, shape (n,)
        What a model leaves of their readings.
    noise_mm : float
        Standard deviation of one reading.

    Returns
    -------
    ndarray of bool, shape (n,)
    """
    off, alone = _core.compare_with_neighbours(
        samples["angle_rad"],
        residual_mm,
        samples.sweeps(),
        noise_mm,
        neighbours=NEIGHBOURS,
        dense_rad=DENSE_RAD,
        doubtful=AGAIN,
        alone=ALONE,
    )
    if alone.mean() > HOPELESS:
        return np.zeros_like(alone)
    off = _without_neighbours(off, alone)
    others = [row for row in np.flatnonzero(alone) if not _is_elsewhere_too(samples, residual_mm, off, row)]
    alone[:] = False
    alone[others] = True
    again = [_again_in_another_lap(samples, off, row) for row in others]
    if not _is_by_chance(again, float(np.mean(np.abs(off) > AGAIN))):
        alone[[row for row, (times, _) in zip(others, again, strict=True) if times]] = False
    return alone if alone.mean() < MOST else np.zeros_like(alone)


def bridged(samples: Samples, residual_mm: Floats, found: Mask) -> Floats:
    """Return a residual with readings that stand alone replaced by what lies between their neighbours."""
    if not found.any():
        return residual_mm
    whole = residual_mm.copy()
    for rows in samples.sweeps():
        gone = found[rows]
        if gone.any() and not gone.all():
            whole[rows[gone]] = np.interp(np.flatnonzero(gone), np.flatnonzero(~gone), residual_mm[rows[~gone]])
    return whole


def glitches_sentence(samples: Samples, residual_mm: Floats, found: Mask) -> str:
    """Return a sentence: how many readings differ from their neighbours by far more than noise, and by how much."""
    count, far_um = int(found.sum()), float(np.abs(residual_mm[found]).max()) * 1e3
    stands = "1 reading stands" if count == 1 else f"{count} readings stand"
    return (
        f"{stands} alone, up to {far_um:.3g} µm off ({100.0 * count / len(samples):.2g} % of all):"
        " glitches of the gauge or its line, by which the model is not judged"
    )


def _from_middle(values: Floats) -> Floats:
    """Return values less the mean of those before and after, zero at the ends."""
    apart = np.zeros_like(values)
    apart[1:-1] = values[1:-1] - 0.5 * (values[:-2] + values[2:])
    return apart


def _without_neighbours(off: Floats, alone: Mask) -> Floats:
    """Return distances from the middle of both neighbours, zero where one of these stands alone and is why."""
    found = off.copy()
    for step in (-1, 1):
        beside = np.flatnonzero(alone) + step
        beside = beside[(beside >= 0) & (beside < len(off))]
        is_why = ~alone[beside] & (off[beside] * off[beside - step] < 0.0)
        found[beside[is_why]] = 0.0
    return found


def _is_elsewhere_too(samples: Samples, residual_mm: Floats, off: Floats, row: np.intp) -> bool:
    """Check whether a reading is the machine's for another reason than that it comes again in another lap.

    It is off to the same side in most other sweeps of the place, or at most sweeps' ends, or is a late jump; or it is
    near a reversal, where the other direction says nothing, no other lap tells, and the drive's other reversals do not
    speak against it.
    """
    near, other_lap = _near(samples, row), _in_another_lap(samples, row)
    sweep = samples["sweep"]
    other_sweep = (samples["set_up"] == samples["set_up"][row]) & (sweep != sweep[row])
    others, also = (np.unique(sweep[near & other_sweep & rows]) for rows in (True, _alike(off, row)))
    if len(also) > 0.5 * len(others) or _is_at_most_ends(samples, off, row):
        return True
    is_repeated = np.any(other_lap & near & (_apart_rad(samples, row) <= SAME_PLACE_RAD))
    may_be_once = not is_repeated and _is_at_reversal(samples, row) and not _is_at_this_alone(samples, off, row)
    return may_be_once or _is_late_jump(samples, residual_mm, row)


def _again_in_another_lap(samples: Samples, off: Floats, row: np.intp) -> tuple[bool, int]:
    """Return whether a reading is off to the same side at its place in another lap, and how many readings are there."""
    there = _near(samples, row) & _in_another_lap(samples, row)
    return bool(np.any(there & _alike(off, row))), int(there.sum())


def _is_by_chance(again: Sequence[tuple[bool, int]], share: float) -> bool:
    """Check that so many readings come again by chance, where a share of all readings is off to either side.

    Of two that meet each comes again: pairs are counted, which are of Poisson's distribution.
    """
    met = sum(each for each, _ in again) / 2.0
    expected = sum(1.0 - (1.0 - 0.5 * share) ** count for _, count in again) / 2.0
    return met == 0.0 or 1.0 - _core.chi_square_tail(max(round(2.0 * met), 1), 2.0 * expected) > CHANCE


def _near(samples: Samples, row: np.intp) -> Mask:
    """Return the readings at the place of one: within a degree, or as near as neighbours are."""
    angle_rad = samples["angle_rad"]
    last = min(int(row), len(angle_rad) - 2)
    step_rad = abs(float(_wrapped(angle_rad[last + 1] - angle_rad[last])))
    near: Mask = _apart_rad(samples, row) <= max(SAME_PLACE_RAD, step_rad)
    return near


def _apart_rad(samples: Samples, row: np.intp) -> Floats:
    angle_rad = samples["angle_rad"]
    apart: Floats = np.abs(_wrapped(angle_rad - angle_rad[row]))
    return apart


def _in_another_lap(samples: Samples, row: np.intp) -> Mask:
    sweep, lap = samples["sweep"], samples["lap"]
    another: Mask = (sweep == sweep[row]) & (lap != lap[row])
    return another


def _alike(off: Floats, row: np.intp) -> Mask:
    """Return the readings that are off to the same side as one, by as much as counts."""
    alike: Mask = off * np.sign(off[row]) > max(AGAIN, ALIKE * abs(off[row]))
    return alike


def _is_at_most_ends(samples: Samples, off: Floats, row: np.intp) -> bool:
    """Check for a sweep's first or last reading that is off in most other sweeps too: what settles after a start."""
    sweeps = samples.sweeps()
    for end in (0, -1):
        ends = np.array([rows[end] for rows in sweeps])
        if row in ends and len(ends) > 1:
            others = np.abs(off[ends[ends != row]]) > AGAIN
            return bool(others.mean() > 0.5)
    return False


def _is_late_jump(samples: Samples, residual_mm: Floats, row: np.intp) -> bool:
    """Check for a reading taken while a drive crosses its play, which the model has crossed at once, or not yet.

    Such a reading is off by no more than the prediction jumps there.
    """
    near = slice(max(int(row) - NEIGHBOURS, 0), int(row) + NEIGHBOURS + 1)
    same = samples["sweep"][near] == samples["sweep"][row]
    left_mm = residual_mm[near][same]
    # Between two readings a smooth contour changes by the mean of the changes before and after.
    jumps_mm = np.abs(_from_middle(np.diff(samples.reading_mm[near][same] - left_mm)))
    return bool(abs(residual_mm[row] - np.median(left_mm)) <= JUMP * jumps_mm.max()) and _is_at_reversal(samples, row)


def _wrapped(angle_rad: Floats) -> Floats:
    """Return angles within half a turn of zero."""
    within: Floats = np.remainder(angle_rad + np.pi, 2.0 * np.pi) - np.pi
    return within


def _is_at_this_alone(samples: Samples, off: Floats, row: np.intp) -> bool:
    """Check that at hardly any other reversal of the drives that turn near a reading another is off as it is."""
    is_off = np.abs(off) > max(AGAIN, ALIKE * abs(off[row]))
    every = [turn for rows in samples.sweeps() for turn in _turns(samples, rows)]
    here = {drive for drive, about in every if row in about}
    shown = [bool(is_off[about].any()) for drive, about in every if drive in here and row not in about]
    return len(shown) >= FEW_REVERSALS and float(np.mean(shown)) <= SELDOM


def _turns(samples: Samples, rows: NDArray[np.intp]) -> Iterator[tuple[int, NDArray[np.intp]]]:
    """Yield the drives that reverse on a sweep, each with the readings about its reversal."""
    time_s, travels = samples["time_s"][rows], samples["travel_direction"][rows]
    for before, drive in np.argwhere(travels[1:] * travels[:-1] < 0.0):
        at_s = 0.5 * (time_s[before] + time_s[before + 1])
        yield int(drive), rows[np.abs(time_s - at_s) <= REVERSAL_S]


def _is_at_reversal(samples: Samples, row: np.intp) -> bool:
    """Check for the reversal of any drive, before or behind a reading."""
    time_s = samples["time_s"]
    near = (samples["sweep"] == samples["sweep"][row]) & (np.abs(time_s - time_s[row]) <= REVERSAL_S)
    return bool(np.any(np.ptp(samples["travel_direction"][near], axis=0) > 0.0))
