"""Steps in time: something shifts once and stays: a loose cup, a gauge that slips, a lost count of an encoder.

For every instant the push from there on is one hypothesis of one to three values. Sums over cells of time give the
fall of the sum of squares of all instants at once; the best cell is then divided again, down to single samples.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.predictors.cross_validation import CrossValidation
from hexdbb.predictors.design import Design
from hexdbb.predictors.names import record_names
from hexdbb.predictors.places import Place
from hexdbb.predictors.pushes import Pushes
from hexdbb.predictors.variable import READING, SECONDS_PER_MINUTE, SLIDERS, FloatArray
from hexdbb.samples import Samples

CELLS = 64
"""Cells of time in each pass."""
PASSES = 3
"""Each narrows the instant to two cells of the pass before: 64 * 32 * 32 cells part records of 65,000 samples."""


@dataclass(frozen=True)
class Step:
    """The best instant for one thing that may shift.

    `size_um` is the shift, or that of the reading (root mean square) where there are several components, of which the
    gauge hardly shows some.
    """

    subject: str
    variable: str
    pushes: str
    place: Place
    size_um: float
    values: int
    design: Design


def steps(samples: Samples, pushes: Pushes | None, tested: CrossValidation) -> Iterator[Step]:
    """Yield the best step of everything that may shift, in any of the records."""
    time_s, record = samples["time_s"], samples["record"]
    in_time = [rows[np.argsort(time_s[rows], kind="stable")] for rows in _rows_of_each(record)]
    for subject, where, weights in _shifting(len(samples), pushes):
        _, first, rows = max((_best(rows, weights, tested) for rows in in_time), key=_gain)
        after = rows[time_s[rows] >= time_s[first]]
        mask = np.zeros(len(weights))
        mask[after] = 1.0
        design = Design.full(weights * mask[:, None])
        yield Step(
            subject=subject,
            variable=f"{subject}, shifting once" if subject != "time" else "time, one shift",
            pushes=where,
            place=_place(samples, first, rows),
            size_um=_size_um(design, tested.fit(design), len(after)),
            values=weights.shape[1] + 1,
            design=design,
        )


def _shifting(count: int, pushes: Pushes | None) -> Iterator[tuple[str, str, FloatArray]]:
    yield "time", READING, np.ones((count, 1))
    if pushes is not None:
        yield "cup", READING, pushes.cup
        yield "ball", READING, pushes.ball
        for k in SLIDERS:
            yield f"slider {k}", "along the guideway", pushes.slider[:, [k - 1]]
            yield f"leg {k}", "in the leg's length", pushes.leg[:, [k - 1]]


def _size_um(design: Design, values: FloatArray, after: int) -> float:
    if len(values) == 1:
        return abs(float(values[0])) * 1e3
    return float(np.sqrt(np.sum(design.times(values) ** 2) / after)) * 1e3


def _gain(found: tuple[float, int, NDArray[np.intp]]) -> float:
    return found[0]


def _rows_of_each(record: NDArray[np.integer]) -> list[NDArray[np.intp]]:
    return [np.flatnonzero(record == which) for which in np.unique(record)]


def _best(rows: NDArray[np.intp], weights: FloatArray, tested: CrossValidation) -> tuple[float, int, NDArray[np.intp]]:
    """Return the gain and the first sample after the best step, and the record's rows in order of time as given."""
    edges = np.unique(np.linspace(0, len(rows), CELLS + 1).astype(np.intp))
    for _ in range(PASSES):
        cells = np.full(len(weights), -1, np.intp)
        cells[rows[edges[0] :]] = np.searchsorted(edges, np.arange(edges[0], len(rows)), side="right") - 1
        gains = tested.step_gains(weights, cells, len(edges))
        gains[0 if edges[0] == 0 else len(gains) - 1] = 0.0  # a step before all samples is none
        cell = int(np.argmax(gains))
        first, gain = int(edges[cell]), float(gains[cell])
        low, high = int(edges[max(cell - 1, 0)]), int(edges[min(cell + 1, len(edges) - 1)])
        edges = np.unique(np.linspace(max(low, 1), max(high, 2), CELLS + 1).astype(np.intp))
    return gain, int(rows[min(first, len(rows) - 1)]), rows


def _place(samples: Samples, row: int, rows: NDArray[np.intp]) -> Place:
    """Return the two samples of a record between which the step is, and the circle in which or before which."""
    before = int(rows[max(int(np.flatnonzero(rows == row)[0]) - 1, 0)])
    where = "in" if samples["sweep"][before] == samples["sweep"][row] else "before"
    direction = "ccw" if samples["direction"][row] > 0 else "cw"
    names, record = record_names(samples.records), samples["record"]
    several = f" of {names[record[row]]}" if len(np.unique(record)) > 1 else ""
    feed_mm_min = SECONDS_PER_MINUTE * samples["feed_mm_s"][row]
    words = f"{where} circle {samples['circle'][row]}, {direction}, {feed_mm_min:g} mm/min{several}"
    return Place(float(samples["time_s"][before]), float(samples["time_s"][row]), words)
