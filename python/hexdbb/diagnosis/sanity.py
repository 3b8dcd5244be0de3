"""Warnings about a fit: values beyond reason, correlated values, fits that do not hold on other circles."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.diagnosis.extrapolation import ExpectedError
from hexdbb.diagnosis.heldout import HeldOut
from hexdbb.diagnosis.sufficiency import Sufficiency
from hexdbb.model import Model, Parameter
from hexdbb.units import readable_unit, shown_factor, shown_unit

FAR_FROM_PRIOR = 5.0
"""Prior standard deviations above which a value is remarked on: one in two million of the prior."""
FEW_READINGS = 2
"""Readings per value below which the prior dominates most values."""
TOGETHER = 0.95
"""Correlation above which only a sum or difference of two values is known: its standard deviation is then a sixth of
theirs."""
NO_BETTER = 0.98
"""Part of the start's error to which the cross-validation error must fall where the training error did: 2 % is
the scatter of a root mean square over a thousand readings."""


def warnings_of(
    model: Model,
    result: _core.FitResult,
    enough: Sufficiency,
    checked: HeldOut | None,
    expected: ExpectedError | None = None,
) -> Iterator[str]:
    """Yield the warnings, one sentence each."""
    readings, values = len(result.residual_mm), len(result.free_columns)
    if readings < FEW_READINGS * values:
        yield f"{readings} readings for {values} values: most values are prior-dominated, not measured"
    yield from _beyond_reason(model, result)
    yield from _correlated(model, result)
    if enough.matters:
        yield f"the model lacks something: {enough.sentence}; hexdbb discover looks for it"
    if checked is not None and expected is not None and expected.extrapolates:
        yield expected.sentence(checked.after_um)
        return
    trained = result.rms_after_mm < NO_BETTER * result.rms_before_mm
    if checked is not None and trained and checked.after_um > NO_BETTER * checked.before_um:
        yield (
            f"held-out circles do not improve ({checked.before_um:.2f} -> {checked.after_um:.2f} µm RMS) though the"
            " fitted ones do: what was fitted does not hold elsewhere"
        )


def _beyond_reason(model: Model, result: _core.FitResult) -> Iterator[str]:
    free = set(result.free_columns)
    for index, (parameter, value) in enumerate(zip(model.parameters(), model.values, strict=True)):
        if parameter.is_coefficient:
            continue
        factor, unit = shown_factor(parameter.unit), readable_unit(shown_unit(parameter.unit))
        shown = f"{parameter.label} is {value * factor:.1f} {unit}"
        from_start = abs(value - parameter.start)
        if parameter.shape is not None:
            near = 0.001 * parameter.prior_sigma
            for word, bound in (("lower", parameter.shape.lower), ("upper", parameter.shape.upper)):
                if abs(value - bound) <= near:
                    yield f"{shown}, at the {word} end of its domain: the readings want it beyond"
        elif abs(value) >= 0.999 * parameter.limit:
            yield f"{shown}, at its limit of {parameter.limit * factor:g} {unit}: beyond it makes no physical sense"
            continue
        if index in free and from_start > FAR_FROM_PRIOR * parameter.prior_sigma:
            yield f"{shown}, {from_start / parameter.prior_sigma:.0f} prior standard deviations: check it"


def _correlated(model: Model, result: _core.FitResult) -> Iterator[str]:
    judged = np.array([not each.is_coefficient for each in model.parameters()], dtype=bool)
    known = np.flatnonzero(model.identifiable & judged)
    known = np.array([column for column in known if column in set(result.free_columns)], dtype=int)
    if len(known) < 2:
        return
    spread = np.sqrt(np.diag(result.covariance))[known]
    correlation = result.covariance[np.ix_(known, known)] / np.outer(spread, spread)
    parameters = model.parameters()
    said = [
        _together(correlation[np.ix_(own, own)], [parameters[known[i]] for i in own])
        for own in _connected(np.abs(correlation) > TOGETHER)
    ]
    groups = "; ".join(each for each in said if each)
    if groups:
        yield f"values are correlated beyond {TOGETHER:g}, only sums or differences are known: {groups}"


def _connected(linked: NDArray[np.bool_]) -> list[NDArray[np.intp]]:
    """Return the members of each group of values that links connect, shape (n, n)."""
    reached = linked | np.eye(len(linked), dtype=bool)
    for _ in range(len(linked).bit_length()):  # each doubles the links that a path may have
        reached = reached @ reached
    first = reached.argmax(axis=1)
    return [np.flatnonzero(first == each) for each in np.unique(first)]


def _together(correlation: NDArray[np.float64], parameters: Sequence[Parameter]) -> str:
    """Name correlated values, with the largest correlation; nothing where there is one only."""
    if len(parameters) < 2:
        return ""
    pairs = correlation[np.triu_indices(len(parameters), k=1)]
    kinds = {(each.effect, each.name) for each in parameters}
    if len(kinds) == 1:
        ((effect, name),) = kinds
        words = f"{':'.join((effect, *(each.element for each in parameters)))} {name}"
    else:
        words = " and ".join(each.label for each in parameters)
    return f"{words} ({pairs[np.argmax(np.abs(pairs))]:+.3f})"
