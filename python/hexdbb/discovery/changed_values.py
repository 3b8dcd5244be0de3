"""What no effect of the catalogue describes and yet is simple: a value of the model that changed during the record.

A cup that came loose, a guideway that bends as it warms: the model's own values, of one element together, that shift
once or drift. Such a change has no place in a model, whose values are constant, but where the verdict is `unknown` it
tells what to look at.

To first order, with J the derivatives by the model's values and g(t) a step or 1 - exp(-t / tau), the columns
B = J_element g(t) are projected and judged as those of the candidates are (`hexdbb.discovery.screen`). No shift is
looked for where the cup is fixed anew: what changes there is set up anew, not loose.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.discovery.screen import offered
from hexdbb.discovery.trial import Base
from hexdbb.record import Record

Floats = NDArray[np.float64]
Rows = NDArray[np.intp]

CHUNKS_PER_SWEEP = 8
TIME_CONSTANTS = (0.1, 0.2, 0.5, 1.0, 4.0)
"""Of a drift, in durations of the records; the last is all but even."""


@dataclass(frozen=True)
class Change:
    """An element whose values changed: how, and what that explains to first order."""

    kind: str
    element: str
    how: str
    bic_drop: float
    share: float
    """Part of what is unexplained that it explains."""

    @property
    def sentence(self) -> str:
        """What it would be, in words."""
        return " ".join(part for part in (self.kind, self.element, "that", self.how) if part)


def best_change(base: Base) -> Change | None:
    """Find the element of a fitted model whose change during the records would explain most of what is left.

    Returns
    -------
    Change or None
        None where the model has no free values.
    """
    search = _Search(base)
    return max((*search.shifts(), *search.drifts()), key=lambda each: each.bic_drop, default=None)


@dataclass(frozen=True)
class _Group:
    """The values of one element of the model: their columns among the free ones."""

    kind: str
    element: str
    columns: Rows


class _Search:
    """Normal equations of short chunks of the records, in order of time; everything in units of the noise."""

    def __init__(self, base: Base) -> None:
        self._base = base
        free = np.flatnonzero(base.model.free)
        engine = base.measured.engine(base.model)
        jacobian = _core.predict(engine, base.measured.samples, want_jacobian=True).jacobian[:, free]
        line = _TimeLine.of(base)
        self._line = line
        self._jacobian = jacobian[line.order] / base.noise.sigma_mm
        self._residual = base.residual_mm[line.order] / base.noise.sigma_mm
        self._information = np.stack([self._jacobian[each].T @ self._jacobian[each] for each in line.chunks])
        self._gradient = np.stack([self._jacobian[each].T @ self._residual[each] for each in line.chunks])
        self._groups = _groups(base, free)
        prior = np.array([each.prior_sigma for each in base.model.parameters()])[free]
        self._covariance = np.linalg.inv(self._information.sum(0) + np.diag(prior**-2.0))
        self._at_rest = self._covariance @ (self._gradient.sum(0) - base.model.values[free] / prior**2)

    def shifts(self) -> Iterator[Change]:
        """Give for each element the best time of a shift."""
        later = _summed_from_each_row(self._information)[1:]
        gradient = _summed_from_each_row(self._gradient)[1:]
        for group in self._groups:
            gain, _ = self._offered(later, later[:, group.columns], gradient, group)
            chunk = int(np.argmax(gain)) + 1
            if self._line.mount[chunk] == self._line.mount[chunk - 1]:
                yield self._refined_shift(chunk, group)

    def drifts(self) -> Iterator[Change]:
        """Give for each element the best time constant of a drift."""
        middle_s = np.array([self._line.time_s[each].mean() for each in self._line.chunks])
        constants_s = np.ptp(self._line.time_s) * np.array(TIME_CONSTANTS)
        grown = -np.expm1(-(middle_s - middle_s[0]) / constants_s[:, None])
        square = np.tensordot(grown**2, self._information, 1)
        cross = np.tensordot(grown, self._information, 1)
        gradient = np.tensordot(grown, self._gradient, 1)
        for group in self._groups:
            gain, count = self._offered(square, cross[:, group.columns], gradient, group)
            best = int(np.argmax(gain - count * np.log(self._base.readings)))
            how = f"drifts with a time constant of {constants_s[best]:.0f} s"
            yield self._change(group, how, float(gain[best]), int(count[best]))

    def _refined_shift(self, chunk: int, group: _Group) -> Change:
        """Look again row by row about the beginning of a chunk."""
        first, last = self._line.chunks[chunk - 1].start, self._line.chunks[chunk].stop
        there, rest = self._jacobian[first:last], self._jacobian[last:]
        own = there[:, group.columns]
        cross = _summed_from_each_row(own[:, :, None] * there[:, None, :]) + rest[:, group.columns].T @ rest
        gradient = _summed_from_each_row(own * self._residual[first:last, None])
        gradient += rest[:, group.columns].T @ self._residual[last:]
        gain, count = self._offered(cross[:, :, group.columns], cross, gradient, group)
        best = int(np.argmax(gain))
        how = f"shifts {_place(self._line, first + best)}"
        return self._change(group, how, float(gain[best]), int(count[best]))

    def _offered(self, square: Floats, cross: Floats, gradient: Floats, group: _Group) -> tuple[Floats, Rows]:
        """Fall of chi-square and visible directions of the group's columns times several g(t).

        `square` is B'B, (m, k, k) or of all values, `cross` B'J, (m, k, p), `gradient` B'r, (m, k) or of all values.
        """
        if square.shape[1] != len(group.columns):
            square = square[:, group.columns][:, :, group.columns]
            gradient = gradient[:, group.columns]
        projected = square - cross @ self._covariance @ cross.transpose(0, 2, 1)
        return offered(projected, gradient - cross @ self._at_rest, np.diagonal(square, axis1=1, axis2=2))

    def _change(self, group: _Group, how: str, gain: float, count: int) -> Change:
        # The time of the change is found from the readings as well.
        bic_drop = gain - (count + 1) * float(np.log(self._base.readings))
        share = min(gain / self._base.excess, 1.0)
        return Change(group.kind, group.element, how, bic_drop, share)


@dataclass(frozen=True)
class _TimeLine:
    """Rows of all records in order of time, cut into chunks within sweeps; `mount` is one number a chunk."""

    order: Rows
    time_s: Floats
    sweep: Rows
    chunks: tuple[slice, ...]
    mount: Rows

    @classmethod
    def of(cls, base: Base) -> _TimeLine:
        """Lay out the records of a fit."""
        record = np.repeat(np.arange(len(base.records)), [len(each) for each in base.records])
        time_s = np.concatenate([each.columns["t_s"] for each in base.records])
        sweep = np.concatenate([each.columns["sweep"] for each in base.records])
        mount = np.concatenate([_mounts(each) for each in base.records])
        order = np.lexsort((time_s, record))
        key = np.column_stack([record, sweep])[order]
        begins = np.flatnonzero(np.any(np.diff(key, axis=0, prepend=-1), axis=1))
        chunks: list[slice] = []
        for begin, end in zip(begins, [*begins[1:], len(order)], strict=True):
            edges = np.unique(np.linspace(begin, end, CHUNKS_PER_SWEEP + 1).astype(np.intp))
            chunks += [slice(int(low), int(high)) for low, high in itertools.pairwise(edges)]
        firsts = order[[each.start for each in chunks]]
        place = np.unique(np.column_stack([record[firsts], mount[firsts]]), axis=0, return_inverse=True)[1]
        return cls(order, time_s[order], sweep[order], tuple(chunks), place.ravel())


def _place(line: _TimeLine, row: int) -> str:
    """Say when: between two sweeps, or at a time within one."""
    if line.sweep[row] != line.sweep[row - 1]:
        return f"between sweeps {line.sweep[row - 1]} and {line.sweep[row]}"
    return f"at {line.time_s[row]:.0f} s"


def _mounts(record: Record) -> Rows:
    of_circle = {circle.id: circle.mount for circle in record.circles}
    return np.array([of_circle[int(each)] for each in record.columns["circle"]], dtype=np.intp)


def _groups(base: Base, free: Rows) -> list[_Group]:
    """Values of one element together: of slider 4 its offset and, where the model has them, its play and pitch."""
    columns: dict[tuple[str, str], list[int]] = {}
    parameters = base.model.parameters()
    for place, column in enumerate(free):
        each = parameters[column]
        info = base.model.info(each.effect)
        if not each.is_shape:
            key = (each.effect, "") if info.element_kind == "machine" else (info.element_kind, each.element)
            columns.setdefault(key, []).append(place)
    return [_Group(kind, element, np.array(places)) for (kind, element), places in columns.items()]


def _summed_from_each_row(values: Floats) -> Floats:
    """Sums over the rows from each one to the last."""
    return np.flip(np.cumsum(np.flip(values, 0), 0), 0)
