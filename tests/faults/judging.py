"""Which samples of a record are wrong: compared with a fault-free run, and with what the nodes really answered.

A sample is known by its sweep and commanded angle. It is right if it equals the same sample of the fault-free run
within noise and resolution. Where the fault moves the machine itself (a lost target, a lost SYNC), other values are
right too, if the seven nodes together gave them in answer to one SYNC: the one after the row's targets were sent.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from tests.faults.bus_log import BusLog

from hexdbb.record import SLIDER_COLUMNS, TARGET_COLUMNS, Record

COUNTS_PER_MM = 10_000.0
POSITION_TOLERANCE_MM = 2.5e-4
"""Difference of a position from the fault-free run, mm: two counts of the encoder and their rounding."""
READING_TOLERANCE_UM = 1.0
"""Difference of a reading from the fault-free run, µm: seven standard deviations of the difference of two readings
(0.1 µm each) and one step of the resolution. The reading changes by 1 µm to 5 µm from one SYNC to the next."""


def rows_by_place(record: Record) -> dict[tuple[int, float], list[int]]:
    """Return the rows of each place of the plan: sweep and commanded angle (deg)."""
    rows: dict[tuple[int, float], list[int]] = {}
    for row, place in enumerate(zip(record.columns["sweep"], record.columns["angle_deg"], strict=True)):
        rows.setdefault((int(place[0]), round(float(place[1]), 9)), []).append(row)
    return rows


def values(record: Record) -> NDArray[np.float64]:
    """Return positions (mm) and reading (µm) of every row, shape (n, 7)."""
    return np.column_stack([record.columns[name] for name in (*SLIDER_COLUMNS, "reading_um")])


def wrong_samples(record: Record | None, reference: Record, log: BusLog | None = None) -> list[int]:
    """Return the rows of a record that are wrong.

    Parameters
    ----------
    record : Record or None
        None if none was written.
    reference : Record
        Of the fault-free run.
    log : BusLog, optional
        What the nodes answered, if the fault moves the machine itself.
    """
    if record is None:
        return []
    expected, found = values(reference), values(record)
    places = rows_by_place(reference)
    tolerance = np.array([POSITION_TOLERANCE_MM] * 6 + [READING_TOLERANCE_UM])
    wrong = []
    for place, rows in rows_by_place(record).items():
        at = places.get(place, [])
        wrong += rows[len(at) :]  # a place that the plan does not have, or a row recorded twice
        for row, reference_row in zip(rows, at, strict=False):
            if not np.all(np.abs(found[row] - expected[reference_row]) <= tolerance):
                wrong.append(row)
    if log is not None:
        answered = answers(log)
        wrong = [row for row in wrong if _key(record, row, found[row]) not in answered]
    return sorted(wrong)


def answers(log: BusLog) -> set[tuple[int, ...]]:
    """Return target counts, position counts and reading (nm) of every SYNC that all seven nodes answered."""
    whole = set()
    for before, cycle in zip(log.cycles, log.cycles[1:], strict=False):
        if len(cycle.positions) == 6 and cycle.reading_um is not None and len(before.commanded) == 6:
            targets = tuple(before.commanded[node] for node in sorted(before.commanded))
            positions = tuple(cycle.positions[node] for node in sorted(cycle.positions))
            whole.add((*targets, *positions, round(cycle.reading_um * 1e3)))
    return whole


def _key(record: Record, row: int, found: NDArray[np.float64]) -> tuple[int, ...]:
    targets_mm = np.array([record.columns[name][row] for name in TARGET_COLUMNS])
    counts = np.rint(np.concatenate([targets_mm, found[:6]]) * COUNTS_PER_MM).astype(int).tolist()
    return (*counts, round(float(found[6]) * 1e3))
