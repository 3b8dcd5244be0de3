"""Is a record such as a machine and a gauge can give? What a run refuses sample by sample, asked of any record.

A well-formed record may hold readings that repeat the last one, jump, or are quieter than the gauge can be. A fit takes
them for the machine's: a gauge that is stuck makes a perfect machine.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.plan import Gauge
from hexdbb.record.columns import SLIDER_COLUMNS
from hexdbb.record.record import Record

SPIKE_UM = 40.0
"""A reading that differs from both its neighbours by this is a disturbance, µm: reversal spikes last longer than one
sample at 250 Hz and reach some 10 to 30 µm on worn machines."""
SPIKE_MM = 0.1
"""The same of a slider coordinate, mm: twenty times what a reversal with stiction makes."""
NOISE_SIGMAS = 12.0
"""The same in standard deviations of a gauge noisier than usual: never reached by chance."""
CHANCE = 1e-12
"""Probability that a working gauge repeats a reading as often as a frozen one is allowed to: none in 1000 years of
runs."""
FEWEST_REPEATS, MOST_REPEATS = 10, 250
"""Bounds of these repetitions: a driver may deliver a few readings twice; one second at 250 Hz bounds what is lost of a
gauge whose noise is small beside its resolution or not stated."""
QUIET = 0.2
"""Part of the stated noise below which the readings are quieter than the gauge can be: specifications are bounds, and
good gauges reach a third of theirs."""

Rows = NDArray[np.intp]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Doubt:
    """Samples that no machine and gauge can have given.

    Attributes
    ----------
    rows : ndarray of int
        From 0.
    what : str
        What is wrong with them, and what was expected.
    """

    rows: Rows
    what: str

    def __str__(self) -> str:
        first, last = int(self.rows[0]) + 1, int(self.rows[-1]) + 1
        if len(self.rows) == 1:
            return f"row {first}: {self.what}"
        place = f"rows {first} to {last}" if last - first + 1 == len(self.rows) else f"row {first} and others"
        return f"{place}: {self.what} ({len(self.rows)} rows)"


def frozen_after(gauge: Gauge) -> int:
    """Return the number of repetitions after which an unchanged reading is a frozen one.

    A reading rounded to steps of q stays the same with a probability of at most erf(q / (2 sqrt(2) sigma)).
    """
    if not gauge.noise_um:
        return MOST_REPEATS
    same = math.erf(gauge.resolution_um / (2.0 * math.sqrt(2.0) * gauge.noise_um))
    if same <= 0.0:
        return FEWEST_REPEATS
    if same >= 1.0:
        return MOST_REPEATS
    return min(max(math.ceil(math.log(CHANCE) / math.log(same)), FEWEST_REPEATS), MOST_REPEATS)


def doubts(record: Record) -> list[Doubt]:
    """Find samples that no machine and gauge can have given; empty where all are plausible."""
    inner = _inner(record)
    found = [*_frozen(record), *_quiet(record, inner), *_reading_spikes(record, inner), *_slider_spikes(record, inner)]
    return [*found, *_too_fast(record)]


def _inner(record: Record) -> Mask:
    """Mark the rows that have both neighbours in their sweep."""
    sweep = record.columns["sweep"]
    inner = np.zeros(len(sweep), np.bool_)
    inner[1:-1] = (sweep[1:-1] == sweep[:-2]) & (sweep[1:-1] == sweep[2:])
    return inner


def _frozen(record: Record) -> Iterator[Doubt]:
    reading, sweep = record.columns["reading_um"], record.columns["sweep"]
    changes = np.flatnonzero((np.diff(reading) != 0.0) | (np.diff(sweep) != 0)) + 1
    edges = np.concatenate([[0], changes, [len(reading)]])
    least = frozen_after(record.gauge)
    stretches = [np.arange(a, b) for a, b in itertools.pairwise(edges) if b - a > least]
    if stretches:
        rows = np.concatenate(stretches)
        value = float(reading[rows[0]])
        expected = "noise" if not record.gauge.noise_um else f"noise of {record.gauge.noise_um:g} µm"
        yield Doubt(rows, f"reading_um stays {value:g} µm, as of a gauge that is stuck (expected {expected})")


def _quiet(record: Record, inner: Mask) -> Iterator[Doubt]:
    stated_um, rows = record.gauge.noise_um, np.flatnonzero(inner)
    if not stated_um or len(rows) < MOST_REPEATS:
        return
    noise_um = float(np.median(np.abs(_bend(record.columns["reading_um"])[inner]))) / (0.6745 * math.sqrt(1.5))
    if noise_um < QUIET * stated_um:
        expected = f"{stated_um:g} µm as stated; with another gauge, state its gauge.noise_um"
        yield Doubt(rows, f"reading_um has a noise of {noise_um:.2g} µm only (expected about {expected})")


def _reading_spikes(record: Record, inner: Mask) -> Iterator[Doubt]:
    limit_um = max(SPIKE_UM, NOISE_SIGMAS * (record.gauge.noise_um or 0.0))
    rows = _spikes(record.columns["reading_um"], inner, limit_um)
    if len(rows):
        off_um = float(_bend(record.columns["reading_um"])[rows[0]])
        yield Doubt(
            rows, f"reading_um differs from both neighbours by {off_um:+.1f} µm (expected {limit_um:g} at most)"
        )


def _slider_spikes(record: Record, inner: Mask) -> Iterator[Doubt]:
    for name in SLIDER_COLUMNS:
        rows = _spikes(record.columns[name], inner, SPIKE_MM)
        if len(rows):
            off_mm = float(_bend(record.columns[name])[rows[0]])
            yield Doubt(
                rows, f"{name} differs from both neighbours by {off_mm:+.3f} mm (expected {SPIKE_MM:g} at most)"
            )


def _too_fast(record: Record) -> Iterator[Doubt]:
    if record.machine.can is None:
        return
    limit_mm_s = record.machine.can.limits.velocity_mm_s
    same = np.diff(record.columns["sweep"]) == 0
    passed_s = np.diff(record.columns["t_s"])
    most_mm = 1.1 * limit_mm_s * passed_s + SPIKE_MM
    for name in SLIDER_COLUMNS:
        step_mm = np.abs(np.diff(record.columns[name]))
        rows = np.flatnonzero(same & (step_mm > most_mm)) + 1
        if len(rows):
            fast_mm_s = float(step_mm[rows[0] - 1] / passed_s[rows[0] - 1])
            yield Doubt(rows, f"{name} moves at {fast_mm_s:.0f} mm/s (expected {limit_mm_s:g} at most)")


def _bend(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return by how much values differ from the mean of their neighbours, shape (n,); zero at both ends."""
    bend = np.zeros(len(values))
    bend[1:-1] = values[1:-1] - 0.5 * (values[:-2] + values[2:])
    return bend


def _spikes(values: NDArray[np.float64], inner: Mask, limit: float) -> Rows:
    """Return rows that lie off the course of their neighbours: these seem off by half of it to the other side."""
    bend = np.where(inner, _bend(values), 0.0)
    far = np.flatnonzero(np.abs(bend) > limit)
    side = np.sign(bend[far])
    rows: Rows = far[np.maximum(bend[far - 1] * side, bend[far + 1] * side) < -0.25 * bend[far] * side]
    return rows
