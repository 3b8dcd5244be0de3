"""Bins of a variable, and the design matrix of its hypothesis: one value for each bin."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hexdbb.predictors.design import Design
from hexdbb.predictors.variable import FloatArray, Variable

PLACE_MM = 3.0
"""Width of a bin on a guideway: narrower than the dents and bends sought, some of a screw's lead of 5 mm."""
SAMPLES_PER_PLACE = 20
"""Fewest samples a bin on a guideway holds on average: a mean then has less than a quarter of the noise."""


@dataclass(frozen=True)
class Binned:
    """A variable in bins.

    Attributes
    ----------
    design : Design
        Weights; columns without a sample are left out.
    group : (columns,) int array
        Number of `Variable.apart` a column belongs to.
    centre : (columns,) array
        Mean of the values there.
    samples : (columns,) array
        Number of samples in each.
    values : (m,) array
        Those that are known.
    column : (m,) int array
        Column of each.
    """

    design: Design
    group: NDArray[np.intp]
    centre: FloatArray
    samples: FloatArray
    values: FloatArray
    column: NDArray[np.intp]

    @cached_property
    def low(self) -> FloatArray:
        """Smallest value of each column, shape (columns,)."""
        low = np.full(len(self.samples), np.inf)
        np.minimum.at(low, self.column, self.values)
        return low

    @cached_property
    def high(self) -> FloatArray:
        """Largest value of each column, shape (columns,)."""
        high = np.full(len(self.samples), -np.inf)
        np.maximum.at(high, self.column, self.values)
        return high


def binned(variable: Variable) -> Binned:
    """Divide a variable into bins; samples whose value is not known have an empty row."""
    weight, every = (_side_by_side(each) for each in zip(*variable.parts, strict=True))
    count, known = len(every), np.isfinite(every)
    if is_whole := bool(known.all()):
        values = every.ravel()
    else:
        values, weight = every[known], np.where(known, weight, 0.0)
    in_bin, bins = _bins(variable, values, count)
    if variable.apart is not None:
        in_bin = in_bin + bins * np.broadcast_to(variable.apart[:, None], known.shape)[known]
    every_bin = np.bincount(in_bin)
    column = np.flatnonzero(every_bin)
    place, samples = (np.cumsum(every_bin > 0) - 1)[in_bin], every_bin[column].astype(float)
    if is_whole:
        column_of = place.astype(np.int32).reshape(known.shape)
    else:
        column_of = np.zeros(known.shape, np.int32)
        column_of[known] = place
    return Binned(
        design=Design(column_of, weight, len(column)),
        group=column // bins,
        centre=np.bincount(place, values) / samples,
        samples=samples,
        values=values,
        column=place,
    )


def _side_by_side(columns: Sequence[FloatArray]) -> FloatArray:
    """Return columns of shape (n,) as a table; a single one as it is, not copied."""
    return columns[0][:, None] if len(columns) == 1 else np.column_stack(columns)


def _bins(variable: Variable, values: FloatArray, count: int) -> tuple[NDArray[np.intp], int]:
    """Return the bin of each value and the number of bins.

    One bin a class where there are few values, else equally filled bins; for angles and places equally wide ones.
    """
    most = variable.bins
    if len(np.unique(values[: 4 * most])) <= most:  # else the first few already have more
        distinct = np.unique(values)
        if len(distinct) <= most:
            return np.searchsorted(distinct, values), len(distinct)
    if variable.unit == "deg":
        # The small summand keeps an angle that is meant to begin a bin out of the one before it.
        return np.floor(values / (360.0 / most) + 1e-9).astype(np.intp) % most, most
    if variable.is_place:
        first, span = values.min(), float(np.ptp(values))
        most = max(min(int(np.ceil(span / PLACE_MM)), count // SAMPLES_PER_PLACE), most)
        return np.minimum(((values - first) / span * most).astype(np.intp), most - 1), most
    # To sort first takes half the time: NumPy sorts by vector instructions, its selection of many places does not.
    edges = np.quantile(np.sort(values), np.linspace(0.0, 1.0, most + 1)[1:-1])
    return np.searchsorted(edges, values), most
