"""The functions of a hypothesis on the samples at hand: their range, their design, and the function they add up to."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.learned import splines
from hexdbb.learned.hypothesis import Directed, Learned
from hexdbb.learned.numbered import INSTANT_S
from hexdbb.learned.ranges import NEVER, SHORTEST, Columns, Ranges, values_of
from hexdbb.learned.signs import at_once, rate_of, transition_rate
from hexdbb.learned.tables import Table
from hexdbb.learned.variable import BENT, ELAPSED, SCREW_LEAD, SPLINES_MIN, is_growing, mount_of

Floats = NDArray[np.float64]
Weight = float | Floats
"""By what a push at a port column is multiplied: one number for all samples, or one for each, shape (n,)."""

SIGN_PART = 0.05
"""A step with the sign of a column is smeared over this part of the column's RMS, within which noise sets the sign."""
WARP_PART = 0.1
"""Splines of a column that turns over with its sign are those of asinh(column / this part of its RMS): what depends on
a velocity or an acceleration (friction, lag, lost motion) changes most where it is near zero."""
POINTS = 41
"""Points of a function's table where the function has few splines: a cubic between two of 12 knots bends little over
three intervals."""
POINTS_PER_SPLINE = 3
SIGN_POINTS = (-3.0, -2.5, -2.0, -1.5, -1.25, -1.0, -0.75, -0.5, -0.25, 0.0)
"""Further points about a step, in its widths, on either side: lines between them miss tanh by 2 % at most."""
SAMPLES_PER_SPLINE = 7
"""Fewest different samples per spline: fewer leave some splines to the prior alone."""
SAMPLES_PER_SPLINE_OF_TURN = 3
"""The same of what repeats: turns are driven evenly, and every turn is read at the same places, where a record has a
reading every half degree. A step between two sectors is then seen with 192 splines, as it is along a rail."""
SMALLEST_RANGE = 1e-9
"""Relative range below which a variable is constant but for rounding."""


@dataclass(frozen=True)
class Space:
    """The functions of one hypothesis, with the limits that samples once set.

    Attributes
    ----------
    hypothesis : Learned
    low, high : float
        Range of the splines' argument: of the column, of its logarithm, or of its inverse hyperbolic sine.
    period : float
        0 where not periodic.
    sign_width : float
        Width of the step with the column's sign; 0 where none.
    warp_width : float
        Value below which the argument is nearly in proportion to the column, and its logarithm beyond; 0: the column.
    since_s, span_s : float
        Beginning and length of the time that a growing function grows over.
    """

    hypothesis: Learned
    low: float = 0.0
    high: float = 1.0
    period: float = 0.0
    sign_width: float = 0.0
    since_s: float = 0.0
    span_s: float = 1.0
    warp_width: float = 0.0

    @classmethod
    def of(cls, hypothesis: Learned, samples: Columns, screw_lead_mm: float) -> Space:
        """Set the limits from samples.

        Raises
        ------
        InputError
            Where the variable is not measured or hardly varies.
        """
        return cls.within(hypothesis, Ranges(samples), screw_lead_mm)

    @classmethod
    def within(cls, hypothesis: Learned, ranges: Ranges, screw_lead_mm: float) -> Space:
        """Set the limits from what samples span; `InputError` likewise."""
        variable, name = hypothesis.variable, hypothesis.name
        period = screw_lead_mm if variable.period == SCREW_LEAD else variable.period
        low, high, sign_width, warp_width = 0.0, period or 1.0, 0.0, 0.0
        if variable.column:
            seen = ranges.of(variable, hypothesis.elements)
            least = max(variable.least, SMALLEST_RANGE * max(-seen.lowest, seen.highest, 1.0))
            if seen.is_known and seen.highest - seen.lowest <= least:
                raise InputError(f"{name}: {variable.column} hardly varies in these samples (expected it to vary)")
            each = SAMPLES_PER_SPLINE_OF_TURN if period else SAMPLES_PER_SPLINE
            enough = 2 if variable.instants else (each if variable.count > 1 else 2) * variable.count
            if seen.different < enough:
                raise InputError(f"{name}: {variable.column} has {seen.different} different values (expected more)")
            if variable.signed:
                sign_width = variable.turns_within or SIGN_PART * seen.rms
                warp_width = 0.0 if variable.is_even else sign_width * WARP_PART / SIGN_PART
            if variable.is_log and not period:
                low, high = seen.log_low, seen.log_high
            elif not period:
                low, high = (float(_warped(np.array(each), warp_width)) for each in (seen.lowest, seen.highest))
        if variable.times and not is_growing(variable.times) and not ranges.acts(variable.times):
            raise InputError(f"{name}: {variable.times} is zero or unknown in all samples (expected it to vary)")
        first, last = ranges.time_s
        return cls(hypothesis, low, high, period, sign_width, first, max(last - first, SMALLEST_RANGE), warp_width)

    @property
    def size(self) -> int:
        """Number of coefficients."""
        return self.hypothesis.size

    @property
    def interval(self) -> float:
        """Distance of two knots, of what the splines are functions of; 0 where there are no splines."""
        variable = self.hypothesis.variable
        return 0.0 if variable.instants else (self.high - self.low) / max(variable.count - SPLINES_MIN, 1)

    def prior_factor(self, roughness: float, steepness: float = 0.0) -> Floats:
        """Return T of the prior covariance T T' of one component's coefficients, shape (columns, columns)."""
        variable = self.hypothesis.variable
        factor = np.eye(variable.columns)
        if variable.instants:
            return factor
        one = splines.prior_factor(variable.count, roughness, steepness, periodic=self.period > 0.0)
        for first in range(0, variable.columns, variable.columns // variable.ways):
            factor[first : first + variable.count, first : first + variable.count] = one
        return factor

    def pushes(
        self, component: int, samples: Columns, machine: Directed
    ) -> Iterator[tuple[int, tuple[tuple[int, Weight], ...]]]:
        """Yield by which element's variable one component goes, and the engine's port columns pushed with weights."""
        hypothesis = self.hypothesis
        lever = hypothesis.lever(component)
        first = _core.PORTS[hypothesis.port][0]
        for element, pushes in hypothesis.pushes(component, machine):
            yield element, tuple((port, samples[lever][:, port - first]) for port, _ in pushes) if lever else pushes

    def design(self, samples: Columns, element: int) -> Floats:
        """Return the functions in every sample for the variable of one element, shape (n, columns)."""
        variable = self.hypothesis.variable
        functions = self._acting(samples, element) if variable.column else np.ones((len(samples), 1))
        parts = [
            self._weight(samples, times, element)[:, None] * functions if times else functions
            for times in variable.all_times
        ]
        return parts[0] if len(parts) == 1 else np.hstack(parts)

    def _weight(self, samples: Columns, times: str, element: int) -> Floats:
        """Return by what a function is multiplied in every sample, shape (n,)."""
        if is_growing(times):
            return _grown(times, samples["time_s"] - self.since_s, self.span_s)
        if (mount := mount_of(times)) is not None:
            return np.asarray(samples["mount"] == mount, np.float64)
        values = np.asarray(samples[times], np.float64)
        return values if values.ndim == 1 else values[:, element]

    def _acting(self, samples: Columns, element: int) -> Floats:
        """Return the splines in every sample, or what lingers of them; shape (n, its own)."""
        variable = self.hypothesis.variable

        def acting(some: Columns) -> Floats:
            return self.functions(values_of(some, variable, element))

        if not variable.lingers_s:
            return acting(samples)
        standing = self.functions(np.zeros(1))[0] if variable.is_zero_at_rest else None
        return samples.lingering(acting, variable.lingers_s, standing)

    def argument(self, samples: Columns, element: int) -> Floats:
        """Return what the splines are functions of, in every sample for the variable of one element, shape (n,)."""
        return self._argument(values_of(samples, self.hypothesis.variable, element))

    def _argument(self, at: Floats) -> Floats:
        is_log = self.hypothesis.variable.is_log
        known = np.where(np.abs(at) < NEVER, at, np.inf if is_log else np.nan)
        return np.log(np.maximum(known, SHORTEST)) if is_log else _warped(known, self.warp_width)

    def functions(self, at: Floats) -> Floats:
        """Return the splines of a function at some values of the column, what multiplies aside; shape (m, its own)."""
        variable = self.hypothesis.variable
        if not variable.column:
            return np.ones((len(at), 1))
        if variable.instants:
            return (at[:, None] >= np.array(variable.instants)).astype(np.float64)
        argument = self._argument(at)
        if variable.count == 1:
            basis = np.nan_to_num(argument)[:, None]
        else:
            low, high = (0.0, self.period) if self.period else (self.low, self.high)
            basis = splines.design(argument, low, high, variable.count, periodic=self.period > 0.0)
            if variable.from_start:
                basis = basis - splines.design(np.array([low]), low, high, variable.count)
        if not variable.signed:
            return basis
        known = np.nan_to_num(at)
        if variable.turns_within:
            return np.column_stack([basis, known / np.hypot(known, self.sign_width)])
        return np.column_stack([basis, np.tanh(known / self.sign_width)])

    def points(self) -> Floats:
        """Return the places of the function's table, in the column's unit; shape (m,)."""
        variable = self.hypothesis.variable
        if not variable.column:
            return np.zeros(1)
        if variable.instants:
            ends = (self.low, *variable.instants, self.high)
            return np.unique([*ends, *(each - 0.5 * INSTANT_S for each in variable.instants)])
        count = max(POINTS, POINTS_PER_SPLINE * variable.count) if variable.count > 1 else 2
        low, high = (0.0, self.period) if self.period else (self.low, self.high)
        at = np.linspace(low, high, count)
        if variable.is_log:
            return np.exp(at)
        if self.warp_width:
            at = self.warp_width * np.sinh(at)
            low, high = at[0], at[-1]
        if self.sign_width:
            about = self.sign_width * np.array(SIGN_POINTS)
            about = np.concatenate([about, -about])
            at = np.union1d(at, about[(about > low) & (about < high)])
        return at

    def counts(self, samples: Columns) -> Floats:
        """Return how many samples lie nearest to each point, shape (m,)."""
        points, variable = self.points(), self.hypothesis.variable
        if len(points) < 2:
            return np.full(1, float(len(samples)))
        values = np.concatenate([values_of(samples, variable, element) for element in self.hypothesis.elements])
        values = values[np.isfinite(values) & (np.abs(values) < NEVER)]
        if self.period:
            values = np.mod(values, self.period)
        edges = 0.5 * (points[1:] + points[:-1])
        return np.bincount(np.searchsorted(edges, values), minlength=len(points)).astype(np.float64)

    def tables(self, coefficients: Floats, machine: Directed) -> tuple[Table, ...]:
        """Return the functions of some coefficients (mm), shape (size,), as a compensation needs them.

        A controller knows the direction of motion only: a smoothed change of sign is abrupt in the table.
        """
        found, points, variable = [], self.points(), self.hypothesis.variable
        basis = self.functions(points)
        for function, part in enumerate(coefficients.reshape(self.hypothesis.functions, -1)):
            times = self.hypothesis.times_of(function)
            rate = rate_of(times)
            table = Table(
                port=self.hypothesis.port,
                column=variable.column,
                times=self.hypothesis.lever(self.hypothesis.component_of(function)) or at_once(times),
                period=self.period,
                pushes=self.hypothesis.pushes(self.hypothesis.component_of(function), machine),
                knots=tuple(map(float, points)),
                values_mm=tuple(map(float, basis @ part)),
                rate=rate or "",
                turns_over=transition_rate(times) if rate else 0.0,
            )
            found.append(table)
        return tuple(found)


def _warped(values: Floats, width: float) -> Floats:
    return np.arcsinh(values / width) if width else values


def _grown(times: str, elapsed_s: Floats, span_s: float) -> Floats:
    """Return how far a growing function has grown, 1 at the end of its time, or in its middle where it ends at 0."""
    part = elapsed_s / span_s
    if times == ELAPSED:
        return part
    if times == BENT:
        return 4.0 * part * (1.0 - part)
    constant_s = float(times.partition("@")[2])
    found: Floats = np.expm1(-elapsed_s / constant_s) / np.expm1(-span_s / constant_s)
    return found
