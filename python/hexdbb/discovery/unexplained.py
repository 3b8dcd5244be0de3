"""Which variable carries what is left: for a fault no known effect explains, so that its finder knows what to write.

For each variable of the samples the residual is averaged in bins, on one half of the data (alternate stretches of
samples), and the averages predict the other half: the share of the unexplained variance they take there is honest,
since noise predicts nothing. For slider positions and time a sine of every period is tried besides,
by Fourier transform on a fine grid.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis import Noise
from hexdbb.discovery.result import Structure
from hexdbb.record import Record

Floats = NDArray[np.float64]

BINS, FINE_BINS = 36, 180
"""Fine ones for slider positions, where a fault may sit at one place of a few millimetres."""
STRETCH = 4
"""So many neighbouring samples go to the same half."""
LEAST_SHARE = 0.02
MOST_NAMED = 8
SHORTEST_PERIOD_MM = 0.5
CELLS = 2**15
OVERSAMPLED = 4
REFINED = 17


@dataclass(frozen=True)
class _Variable:
    name: str
    values: Floats
    unit: str
    group: NDArray[np.intp] | None = None
    """Bins are kept apart by this number (circle, direction)."""
    may_repeat: bool = False
    is_fine: bool = False


def unexplained_structure(records: Sequence[Record], residual_mm: Floats, noise: Noise) -> tuple[Structure, ...]:
    """Rank variables by the share of the unexplained variance they carry, largest first.

    Parameters
    ----------
    records : sequence of Record
    residual_mm : ndarray, shape (n,)
        Of all records, one after another.
    noise : Noise
    """
    excess = float(np.mean(residual_mm**2)) - noise.sigma_mm**2
    if excess <= 0.0:
        return ()
    halves = (np.arange(len(residual_mm)) // STRETCH) % 2
    found = []
    for variable in _variables(records):
        share = _binned_share(variable, residual_mm, halves, excess)
        if share > LEAST_SHARE:
            found.append(Structure(variable.name, min(share, 1.0), None, variable.unit))
        if variable.may_repeat:
            period, share = _periodic_share(variable.values, residual_mm, halves, excess)
            if share > LEAST_SHARE:
                found.append(Structure(f"{variable.name}, repeating", min(share, 1.0), period, variable.unit))
    return tuple(sorted(found, key=lambda each: -each.share)[:MOST_NAMED])


def _variables(records: Sequence[Record]) -> Iterator[_Variable]:
    def column(name: str) -> Floats:
        return np.concatenate([record.columns[name].astype(float) for record in records])

    circle = np.unique(
        np.concatenate([1000 * index + record.columns["circle"] for index, record in enumerate(records)]),
        return_inverse=True,
    )[1]
    way = (column("direction") > 0).astype(np.intp)
    angle = column("angle_deg") % 360.0
    yield _Variable("angle", angle, "deg")
    yield _Variable("angle on each circle", angle, "deg", circle)
    yield _Variable("angle by direction", angle, "deg", way)
    yield _Variable("circle (height, tilt, yaw)", circle.astype(float), "")
    yield _Variable("direction", way.astype(float), "")
    yield _Variable("feed", column("feed_mm_min"), "mm/min")
    yield _Variable("time", column("t_s"), "s", None, True)
    for k in range(1, 7):
        place = column(f"s{k}_mm")
        yield _Variable(f"slider {k} position", place, "mm", None, may_repeat=True, is_fine=True)
        yield _Variable(f"slider {k} position by direction of motion", place, "mm", _moving(records, k), is_fine=True)
    if all("temperature_c" in record.columns for record in records):
        yield _Variable("temperature", column("temperature_c"), "degC")


def _moving(records: Sequence[Record], k: int) -> NDArray[np.intp]:
    moving = []
    for record in records:
        own = np.zeros(len(record.columns["t_s"]), dtype=np.intp)
        for rows in record.sweeps():
            if len(rows) > 1:
                own[rows] = np.gradient(record.columns[f"s{k}_mm"][rows]) > 0.0
        moving.append(own)
    return np.concatenate(moving)


def _bins(variable: _Variable) -> NDArray[np.intp]:
    distinct = np.unique(variable.values)
    count = FINE_BINS if variable.is_fine else BINS
    if len(distinct) <= count:
        own = np.searchsorted(distinct, variable.values)
    else:
        edges = np.quantile(variable.values, np.linspace(0.0, 1.0, count + 1)[1:-1])
        own = np.searchsorted(edges, variable.values)
    if variable.group is not None:
        own = own + (count + 1) * variable.group
    return own.astype(np.intp)


def _binned_share(variable: _Variable, residual: Floats, halves: NDArray[np.intp], excess: float) -> float:
    bins = _bins(variable)
    count = int(bins.max()) + 1
    gained = 0.0
    for half in (0, 1):
        train, judge = halves == half, halves != half
        total = np.bincount(bins[train], residual[train], count)
        number = np.bincount(bins[train], minlength=count)
        mean = np.divide(total, number, out=np.zeros(count), where=number > 0)[bins[judge]]
        gained += float(np.sum(residual[judge] ** 2 - (residual[judge] - mean) ** 2))
    return gained / len(residual) / excess


def _periodic_share(values: Floats, residual: Floats, halves: NDArray[np.intp], excess: float) -> tuple[float, float]:
    """Period of the best sine, found on one half, and the share it takes on the other."""
    train, judge = halves == 0, halves == 1
    best = _strongest_frequency(values[train], residual[train])
    basis = np.column_stack([np.cos(2.0 * np.pi * best * values), np.sin(2.0 * np.pi * best * values)])
    wave = basis[judge] @ np.linalg.lstsq(basis[train], residual[train], rcond=None)[0]
    gained = float(np.mean(residual[judge] ** 2 - (residual[judge] - wave) ** 2))
    return 1.0 / best, gained / excess


def _strongest_frequency(values: Floats, residual: Floats) -> float:
    """Frequency whose sine takes most of a residual given at uneven places.

    Residuals are summed in `CELLS` cells and transformed at once (Press and Rybicki 1989, without the spreading: a cell
    is short against the shortest period sought); the best of the grid is then refined by least squares.
    """
    spread = float(np.ptp(values))
    cell = np.minimum(((values - values.min()) / spread * CELLS).astype(np.intp), CELLS - 1)
    padded = OVERSAMPLED * CELLS
    power = np.abs(np.fft.rfft(np.bincount(cell, residual, CELLS), padded)) ** 2
    frequency = np.arange(len(power)) * CELLS / padded / spread
    highest = min(1.0 / SHORTEST_PERIOD_MM if spread < CELLS else np.inf, 0.25 * CELLS / spread)
    allowed = (frequency >= 2.0 / spread) & (frequency <= max(highest, 4.0 / spread))
    coarse = float(frequency[allowed][int(np.argmax(power[allowed]))])
    near = coarse + np.linspace(-0.5, 0.5, REFINED) / spread / OVERSAMPLED
    turns = 2.0 * np.pi * np.outer(values, near)
    strength = (residual @ np.cos(turns)) ** 2 + (residual @ np.sin(turns)) ** 2
    return float(near[int(np.argmax(strength))])
