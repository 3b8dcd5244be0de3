"""What the residual may depend on: each variable of the samples' state, and how much of the residual it carries.

The residual is averaged in bins of the variable over one half of the laps, and these averages predict the other half,
and the other way round. The part of the mean square residual that they take away there is the variable's share: noise
predicts nothing, so a share is structure. Shares overlap where variables go together, and need not add up to one.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.compare.circles import SHORT_DIRECTION_NAMES
from hexdbb.compare.samples import SLIDERS, Columns, codes, halves
from hexdbb.iso230 import FloatArray

NEVER_S = 1e5
"""Times since a reversal beyond this stand for a reversal that never was."""
DIRECTIONS = (SHORT_DIRECTION_NAMES[-1], SHORT_DIRECTION_NAMES[1])
WAYS = ("moving down", "moving up")
BINS = 36
"""Ten degrees each for the angle."""


@dataclass(frozen=True)
class Variable:
    """One variable of the samples.

    Attributes
    ----------
    name : str
        In words: ``slider 4 position, each way``.
    unit : str
        Of `values`; empty where they are classes.
    values : (n,) array
        nan where not known.
    apart : (n,) int array or None
        Samples of different numbers are averaged apart: directions, ways of moving.
    names : tuple of str
        What the numbers of `apart` stand for, from 0, where there is something to say.
    """

    name: str
    unit: str
    values: FloatArray
    apart: NDArray[np.intp] | None = None
    names: tuple[str, ...] = ()


@dataclass(frozen=True)
class BinnedMeans:
    """Means of the residual over the bins of a variable, for drawing: one line for each number of `apart`."""

    name: str
    centre: FloatArray
    mean_um: FloatArray


@dataclass(frozen=True)
class Dependence:
    """How much of the mean square residual a variable carries, from 0 to 1, and the means of the residual over it."""

    variable: str
    unit: str
    share: float
    means: tuple[BinnedMeans, ...]


def dependences(columns: Columns) -> list[Dependence]:
    """Judge every variable; the largest share first.

    Parameters
    ----------
    columns : dict of str to (n,) arrays
        As `hexdbb.compare.samples.sample_columns` gives them.
    """
    residual_um, second = columns["residual_um"], halves(columns)
    found = [_dependence(each, residual_um, second) for each in variables(columns)]
    return sorted(found, key=lambda each: each.share, reverse=True)


def variables(columns: Columns) -> Iterator[Variable]:
    """Yield the variables the columns have; one that stands still says nothing and is left out."""
    return (each for each in _every(columns) if len(np.unique(each.values[np.isfinite(each.values)])) > 1)


def _every(columns: Columns) -> Iterator[Variable]:
    angle_deg, way = columns["angle_deg"] % 360.0, (columns["direction"] > 0).astype(np.intp)
    yield Variable("angle", "deg", angle_deg)
    yield Variable("angle, each direction", "deg", angle_deg, way, DIRECTIONS)
    yield Variable("angle, each circle", "deg", angle_deg, _circles(columns))
    yield Variable("direction", "", columns["direction"].astype(np.float64))
    yield Variable("circle", "", _circles(columns).astype(np.float64))
    yield Variable("feed", "mm/min", columns["feed_mm_min"])
    yield Variable("time", "s", columns["t_s"])
    if "temperature_c" in columns:
        yield Variable("temperature", "°C", columns["temperature_c"])
    for k in SLIDERS:
        yield from _of_slider(columns, k)


def _of_slider(columns: Columns, k: int) -> Iterator[Variable]:
    position_mm = columns[f"s{k}_mm"]
    yield Variable(f"slider {k} position", "mm", position_mm)
    if f"side{k}" in columns:
        side = columns[f"side{k}"]
        yield Variable(f"slider {k} position, each way", "mm", position_mm, (side > 0.0).astype(np.intp), WAYS)
        yield Variable(f"slider {k} way of moving", "", side.astype(np.float64))
    if f"v{k}_mm_s" in columns:
        yield Variable(f"slider {k} velocity", "mm/s", columns[f"v{k}_mm_s"])
    if f"since_reversal{k}_s" in columns:
        since_s = columns[f"since_reversal{k}_s"]
        # Before the first reversal of a sweep nothing is known of the time since one.
        yield Variable(f"time since slider {k} reversed", "s", np.where(since_s < NEVER_S, since_s, np.nan))


def _circles(columns: Columns) -> NDArray[np.intp]:
    keys = np.column_stack([codes(columns["record"]), columns["circle"]])
    return np.unique(keys, axis=0, return_inverse=True)[1].ravel()


def _dependence(variable: Variable, residual_um: FloatArray, second: NDArray[np.bool_]) -> Dependence:
    known = np.isfinite(variable.values)
    values, residual, half = variable.values[known], residual_um[known], second[known]
    apart = np.zeros(len(values), np.intp) if variable.apart is None else variable.apart[known]
    own, count = _bins(variable, values)
    bins = own + count * apart
    gained = sum(_gained(bins, residual, half == each) for each in (False, True))
    total = float(np.sum(residual_um**2))
    share = min(max(gained / total, 0.0), 1.0) if total > 0.0 else 0.0
    means = tuple(
        _means(variable.names[each] if variable.names else "", values, residual, own, count, apart == each)
        for each in np.unique(apart)
    )
    return Dependence(variable.name, variable.unit, share, means)


def _bins(variable: Variable, values: FloatArray) -> tuple[NDArray[np.intp], int]:
    """Bin of each value: one a class where there are few, else equally filled ones; of an angle, equally wide ones."""
    distinct = np.unique(values)
    if len(distinct) <= BINS:
        return np.searchsorted(distinct, values), len(distinct)
    if variable.unit == "deg":
        # The small summand keeps an angle that is meant to begin a bin out of the one before it.
        return np.floor(values / (360.0 / BINS) + 1e-9).astype(np.intp) % BINS, BINS
    edges = np.quantile(values, np.linspace(0.0, 1.0, BINS + 1)[1:-1])
    return np.searchsorted(edges, values), BINS


def _gained(bins: NDArray[np.intp], residual: FloatArray, train: NDArray[np.bool_]) -> float:
    """Sum of squares that the means of the training half take from the other half; none where a bin was not seen."""
    count = int(bins.max()) + 1
    seen = np.bincount(bins[train], minlength=count)
    total = np.bincount(bins[train], residual[train], count)
    judged = ~train
    mean = np.divide(total, seen, out=np.zeros(count), where=seen > 0)[bins[judged]]
    return float(np.sum(residual[judged] ** 2 - (residual[judged] - mean) ** 2))


def _means(
    name: str, values: FloatArray, residual: FloatArray, bins: NDArray[np.intp], count: int, here: NDArray[np.bool_]
) -> BinnedMeans:
    seen = np.bincount(bins[here], minlength=count)
    there = seen > 0
    centre = np.bincount(bins[here], values[here], count)[there] / seen[there]
    mean = np.bincount(bins[here], residual[here], count)[there] / seen[there]
    return BinnedMeans(name, centre, mean)
