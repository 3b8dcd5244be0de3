"""What readings propose as a hypothesis, and where something may shift or swing at all."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.linear.readings import Readings
from hexdbb.learned import ALL, PAIRS, Learned, step
from hexdbb.learned.places import LEVERS

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Proposal:
    """A hypothesis and its log prior relative to those that are not chosen by the readings."""

    hypothesis: Learned
    log_prior: float


def shifting() -> Iterator[tuple[str, int]]:
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


def answers_at(readings: Readings, place: str, element: int) -> Floats:
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
