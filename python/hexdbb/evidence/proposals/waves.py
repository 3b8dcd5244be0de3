"""What repeats along a slider's travel, more or less by how fast or where it is: proposed where readings say so.

A period along the travel is found as `periods.py` finds one, with one amplitude. Where it swings at some speeds only,
as cogging that a drive holds down, or in a part of the travel, as of a screw that is worn there, its cosine and its
sine are each given a function of the velocity, or of the position.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.criteria import Criteria
from hexdbb.evidence.linear.readings import Linear, Readings
from hexdbb.evidence.proposals.periods import periods
from hexdbb.evidence.proposals.proposed import Proposal
from hexdbb.learned import Learned
from hexdbb.learned.repeating import WAVES, wave
from hexdbb.learned.variables import POSITION, VELOCITY

Floats = NDArray[np.float64]

UNLIKE = 0.5
"""Part of a swing's amplitude in one half of the readings below which that in the other says that its amplitude
changes: half as much is what a straight line to zero leaves between the middles of two halves of it, and a third."""
LEAST_TURNS = 6.0
"""Turns over the travel, at least: an amplitude of twelve splines (`WAVE_SPLINES`) bends as fast as a longer wave."""
ALONG = ("slider", "slider_joint", "lateral", "vertical")
"""Places that are sought for it, along one axis or more."""
BY = dict(zip(WAVES, (VELOCITY, POSITION), strict=True))


def waves(linear: Linear, readings: Readings, criteria: Criteria) -> Iterator[Proposal]:
    """Yield what repeats along sliders' travel with an amplitude that changes with the velocity or the position.

    Parameters
    ----------
    linear : Linear
        About what is found already.
    readings : Readings
    criteria : Criteria
        Has the shortest period.
    """
    if "time_s" in readings.state.unmeasured:  # no velocity
        return
    for found in periods(linear, readings, criteria, _is_along):
        period = found.hypothesis.variable.period
        if LEAST_TURNS * period > float(np.ptp(readings.state[POSITION.column], axis=0).max()):
            continue
        for name in WAVES:
            if _is_unlike(found.hypothesis, name, linear, readings):
                yield replace(found, hypothesis=replace(found.hypothesis, variable=wave(BY[name], period)))


def _is_along(learned: Learned) -> bool:
    return learned.place in ALONG and learned.variable.column == POSITION.column


def _is_unlike(found: Learned, by: str, linear: Linear, readings: Readings) -> bool:
    """Check whether a swing is much smaller in one half of the readings, slow or fast, at one end or the other."""
    state, own = readings.state, np.abs if by == "velocity" else np.asarray
    phase = 2.0 * np.pi * state[POSITION.column] / found.variable.period
    halves = np.zeros((2, found.components, 2))
    squares = np.zeros((2, found.components))
    for axis in range(found.components):
        for column, ports in found.pushes(axis, state.machine):
            answer = readings.answer(ports)
            weighted = linear.residual * answer
            values = own(state[BY[by].column][:, column])
            half = (values > np.median(values)).astype(int)
            for place, turned in enumerate((np.cos(phase[:, column]), np.sin(phase[:, column]))):
                halves[:, axis, place] += np.bincount(half, weighted * turned, 2)
            squares[:, axis] += np.bincount(half, answer**2, 2)
    sizes = np.linalg.norm((halves / np.maximum(squares, 1e-300)[:, :, None]).reshape(2, -1), axis=1)
    return float(sizes.min()) < UNLIKE * float(sizes.max())
