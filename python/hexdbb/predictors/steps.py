"""Something that shifts once and stays: a loose cup, a ball set anew, a gauge that slips, a lost count of an encoder.

For every instant the push from there on is one hypothesis of one to three values. Sums over cells of time give the
fall of the sum of squares of all instants at once; the best is then cut up again, down to single samples.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from hexdbb.predictors.columns import SLIDERS, Columns, FloatArray
from hexdbb.predictors.judge import Judge
from hexdbb.predictors.places import Place
from hexdbb.predictors.pushes import Pushes

CELLS = 64
PASSES = 3
"""Each narrows the instant to two of the pass before's cells."""
IN_READING = "in the reading"


@dataclass(frozen=True)
class Step:
    """The best instant for one thing that may shift.

    `size_um` is how far, or how far the reading (root mean square) where there are several components: the gauge hardly
    sees some of them.
    """

    subject: str
    variable: str
    pushes: str
    place: Place
    size_um: float
    values: int
    design: sparse.csr_matrix


def steps(columns: Columns, pushes: Pushes | None, judge: Judge) -> Iterator[Step]:
    """Yield the best step of everything that may shift, in any of the records."""
    for subject, where, weights in _shifting(len(columns["t_s"]), pushes):
        best = max((_best(columns, weights, judge, record) for record in np.unique(columns["record"])), key=_gain)
        _, first, rows = best
        after = rows[columns["t_s"][rows] >= columns["t_s"][first]]
        mask = np.zeros(len(weights))
        mask[after] = 1.0
        design = sparse.csr_matrix(weights * mask[:, None])
        yield Step(
            subject=subject,
            variable=f"{subject}, shifting once" if subject != "time" else "time, one shift",
            pushes=where,
            place=_place(columns, first, rows),
            size_um=_size_um(design, judge.fit(design), len(after)),
            values=weights.shape[1] + 1,
            design=design,
        )


def _shifting(count: int, pushes: Pushes | None) -> Iterator[tuple[str, str, FloatArray]]:
    yield "time", IN_READING, np.ones((count, 1))
    if pushes is not None:
        yield "cup", IN_READING, pushes.cup
        yield "ball", IN_READING, pushes.ball
        for k in SLIDERS:
            yield f"slider {k}", "along the guideway", pushes.slider[:, [k - 1]]
            yield f"leg {k}", "in the leg's length", pushes.leg[:, [k - 1]]


def _size_um(design: sparse.csr_matrix, values: FloatArray, after: int) -> float:
    if len(values) == 1:
        return abs(float(values[0])) * 1e3
    return float(np.sqrt(np.sum((design @ values) ** 2) / after)) * 1e3


def _gain(found: tuple[float, int, NDArray[np.intp]]) -> float:
    return found[0]


def _best(columns: Columns, weights: FloatArray, judge: Judge, record: str) -> tuple[float, int, NDArray[np.intp]]:
    """Gain, first sample after the best step, and the record's samples in order of time."""
    rows = np.flatnonzero(columns["record"] == record)
    rows = rows[np.argsort(columns["t_s"][rows], kind="stable")]
    edges = np.unique(np.linspace(0, len(rows), CELLS + 1).astype(np.intp))
    for _ in range(PASSES):
        cells = np.full(len(weights), -1, np.intp)
        cells[rows[edges[0] :]] = np.searchsorted(edges, np.arange(edges[0], len(rows)), side="right") - 1
        gains = judge.step_gains(weights, cells, len(edges))
        gains[0 if edges[0] == 0 else len(gains) - 1] = 0.0  # a step before all samples is none
        cell = int(np.argmax(gains))
        first, gain = int(edges[cell]), float(gains[cell])
        low, high = int(edges[max(cell - 1, 0)]), int(edges[min(cell + 1, len(edges) - 1)])
        edges = np.unique(np.linspace(max(low, 1), max(high, 2), CELLS + 1).astype(np.intp))
    return gain, int(rows[min(first, len(rows) - 1)]), rows


def _place(columns: Columns, row: int, rows: NDArray[np.intp]) -> Place:
    """Say between which two samples of a record it was, and in which circle or before which."""
    before = int(rows[max(int(np.flatnonzero(rows == row)[0]) - 1, 0)])
    where = "in" if columns["sweep"][before] == columns["sweep"][row] else "before"
    way = "ccw" if columns["direction"][row] > 0 else "cw"
    several = f" of {columns['record'][row]}" if len(np.unique(columns["record"])) > 1 else ""
    words = f"{where} circle {columns['circle'][row]}, {way}, {columns['feed_mm_min'][row]:g} mm/min{several}"
    return Place(float(columns["t_s"][before]), float(columns["t_s"][row]), words)
