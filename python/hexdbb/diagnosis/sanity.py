"""What does not make sense in a fit: values beyond reason, values that go together, fits that do not hold elsewhere."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from hexdbb import _core
from hexdbb.diagnosis.extrapolation import Foretold
from hexdbb.diagnosis.heldout import HeldOut
from hexdbb.diagnosis.noise import Noise
from hexdbb.model import Model, Parameter
from hexdbb.units import shown_factor, shown_unit

FAR_FROM_PRIOR = 5.0
"""Values beyond this many expected sizes are remarkable."""
FEW_READINGS = 2
"""Fewer readings than so many a value tell little."""
TOGETHER = 0.95
"""Correlation beyond which two values cannot be told apart."""
LACK_OF_FIT = 1.5
"""Residual over noise beyond which the model misses something."""
NO_BETTER = 0.98
"""Held-out error must fall at least to this part where the training error did."""


def warnings_of(
    model: Model, result: _core.FitResult, noise: Noise, checked: HeldOut | None, expected: Foretold | None = None
) -> Iterator[str]:
    """Yield what to beware of, one sentence each."""
    readings, values = len(result.residual_mm), len(result.free_columns)
    if readings < FEW_READINGS * values:
        yield f"{readings} readings for {values} values: most of what is shown is what was expected, not what was read"
    yield from _beyond_reason(model, result)
    yield from _correlated(model, result)
    noise_um, after_um = noise.sigma_mm * 1e3, result.rms_after_mm * 1e3
    if after_um > LACK_OF_FIT * noise_um:
        yield (
            f"residual {after_um:.2f} um against {noise_um:.2f} um of noise ({noise.source}): the model misses"
            " something, and the uncertainties are stretched to match"
        )
    if checked is not None and expected is not None and expected.extrapolates:
        yield expected.sentence(checked.after_um)
        return
    trained = result.rms_after_mm < NO_BETTER * result.rms_before_mm
    if checked is not None and trained and checked.after_um > NO_BETTER * checked.before_um:
        yield (
            f"held-out circles do not improve ({checked.before_um:.2f} -> {checked.after_um:.2f} um) though the fitted"
            " ones do: what was fitted does not hold elsewhere"
        )


def _beyond_reason(model: Model, result: _core.FitResult) -> Iterator[str]:
    free = set(result.free_columns)
    for index, (parameter, value) in enumerate(zip(model.parameters(), model.values, strict=True)):
        factor, unit = shown_factor(parameter.unit), shown_unit(parameter.unit)
        shown = f"{parameter.label} is {value * factor:.1f} {unit}"
        if abs(value) >= 0.999 * parameter.limit:
            yield f"{shown}, at its limit of {parameter.limit * factor:g} {unit}: beyond it makes no physical sense"
        elif index in free and abs(value) > FAR_FROM_PRIOR * parameter.prior_sigma:
            yield f"{shown}, {abs(value) / parameter.prior_sigma:.0f} times the size to expect: look at it"


def _correlated(model: Model, result: _core.FitResult) -> Iterator[str]:
    known = np.flatnonzero(np.concatenate([np.zeros(0, bool), *(term.identifiable for term in model.terms)]))
    known = np.array([column for column in known if column in set(result.free_columns)], dtype=int)
    if len(known) < 2:
        return
    spread = np.sqrt(np.diag(result.covariance))[known]
    correlation = result.covariance[np.ix_(known, known)] / np.outer(spread, spread)
    parameters = model.parameters()
    count, group = connected_components(np.abs(correlation) > TOGETHER, directed=False)
    members = [np.flatnonzero(group == each) for each in range(count)]
    said = [_together(correlation[np.ix_(own, own)], [parameters[known[i]] for i in own]) for own in members]
    groups = "; ".join(each for each in said if each)
    if groups:
        yield f"values go together (correlation beyond {TOGETHER:g}), only sums or differences are sure: {groups}"


def _together(correlation: NDArray[np.float64], parameters: Sequence[Parameter]) -> str:
    """Name values that go together, with the largest correlation; nothing where there is one only."""
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
