"""Trying a candidate in earnest: the model with the effect, fitted nonlinearly, judged where it was not fitted.

A screen to first order proposes; second-order geometry can look like a small bow of a guideway there. So every
candidate that matters gets a fit of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from hexdbb import _core
from hexdbb.diagnosis import Noise, evaluate_fit
from hexdbb.discovery.result import Candidate
from hexdbb.discovery.screen import shaped
from hexdbb.model import Choice, Model, Size
from hexdbb.samples import Samples
from hexdbb.units import shown_factor, shown_unit

Floats = NDArray[np.float64]


CLEARLY = 10.0
"""An element's weight must exceed the cost of its parameters by this much."""
SMALLEST_PART = 0.01
"""Of the weight of the effect's strongest element: below it an element mends the others' shape."""


@dataclass(frozen=True)
class Base:
    """The model a candidate must improve on, fitted to the same records."""

    samples: Samples
    model: Model
    noise: Noise
    squared: float
    """Sum of squared residuals over the noise's variance."""
    residual_mm: Floats

    @property
    def readings(self) -> int:
        """Number of readings."""
        return len(self.residual_mm)

    @property
    def excess(self) -> float:
        """Chi-square beyond what noise alone leaves."""
        return max(self.squared - self.readings, 1e-9)


def fitted_base(samples: Samples, model: Model, noise: Noise) -> Base:
    """Fit a model's free values and keep what candidates are compared with."""
    fitted, result = evaluate_fit(samples, model, model.free, noise, hypothesis=True)
    residual = result.residual_mm
    return Base(samples, fitted, noise, float(residual @ residual) / noise.sigma_mm**2, residual)


def with_effect(model: Model, effect: str, elements: Sequence[str], shape: float = 0.0) -> Model:
    """Return the model with an effect's elements free as well, at zero; its other elements are held.

    Values that only shape the others start at `shape` expected sizes.
    """
    wider = model.with_effect(Choice(effect, tuple(elements)))
    present = model.term(effect)
    freed = wider.values_of(Choice(effect, tuple(elements)))
    if present is not None:
        freed[np.flatnonzero(wider.values_of(Choice(effect)))] &= ~present.free
    return shaped(wider, freed, shape)


def try_effect(
    base: Base, effect: str, elements: Sequence[str], shape: float = 0.0
) -> tuple[Candidate, _core.FitResult]:
    """Fit the base's model with an effect; the p-value is not corrected for other candidates yet.

    Elements that to first order seemed to pay but hardly contribute once the effect has its true size are left out, and
    the rest is fitted again.
    """
    wider = with_effect(base.model, effect, elements, shape)
    fitted, result = evaluate_fit(base.samples, wider, wider.free, base.noise, hypothesis=True)
    kept = contributing(base, fitted, result, effect, elements) or tuple(elements)
    if kept != tuple(elements):
        elements = kept
        wider = with_effect(base.model, effect, elements, shape)
        fitted, result = evaluate_fit(base.samples, wider, wider.free, base.noise, hypothesis=True)
    squared = float(result.residual_mm @ result.residual_mm) / base.noise.sigma_mm**2
    candidate = Candidate(
        effect=effect,
        elements=tuple(elements),
        rms_after_um=result.rms_after_mm * 1e3,
        chi_square_drop=base.squared - squared,
        bic_drop=0.0,
        p_value=1.0,
        share=min(max((base.squared - squared) / base.excess, 0.0), 1.0),
        values=_values(fitted, result, effect, elements),
        model=fitted,
    )
    return weighed(base, candidate, result.correlation), result


def weighed(base: Base, candidate: Candidate, correlation: float, before: float = 1.0) -> Candidate:
    """Give a candidate's evidence where so many neighbouring readings tell as much as one; `before`, so many did."""
    values = int(candidate.model.free.sum() - base.model.free.sum())
    drop = candidate.chi_square_drop * before / correlation
    return replace(
        candidate,
        chi_square_drop=drop,
        bic_drop=drop - values * float(np.log(base.readings / correlation)),
        p_value=float(stats.chi2.sf(max(drop, 0.0), max(values, 1))),
    )


def holm(candidates: Sequence[Candidate], tried: int) -> list[Candidate]:
    """Correct p-values for all candidates tried (Holm 1979), those only screened included."""
    ordered = sorted(candidates, key=lambda each: each.p_value)
    corrected, floor = [], 0.0
    for rank, candidate in enumerate(ordered):
        floor = max(floor, min(candidate.p_value * (tried - rank), 1.0))
        corrected.append(replace(candidate, p_value=floor))
    return corrected


def contributing(
    base: Base, fitted: Model, result: _core.FitResult, effect: str, elements: Sequence[str]
) -> tuple[str, ...]:
    """Elements whose values stand clear of zero (Wald): more than they cost, and a part of what the best one gives."""
    parameters = fitted.parameters()
    weight, cost = {}, {}
    for element in elements:
        columns = [index for index, each in enumerate(parameters) if each.effect == effect and each.element == element]
        spread = result.covariance[np.ix_(columns, columns)]
        values = fitted.values[columns]
        weight[element] = float(values @ np.linalg.pinv(spread, hermitian=True) @ values)
        cost[element] = len(columns) * float(np.log(base.readings)) + CLEARLY
    part = SMALLEST_PART * max(weight.values())
    return tuple(element for element in elements if weight[element] >= max(cost[element], part))


def _values(model: Model, result: _core.FitResult, effect: str, elements: Sequence[str]) -> tuple[Size, ...]:
    spread = np.sqrt(np.diag(result.covariance))
    rows = []
    for index, each in enumerate(model.parameters()):
        if each.effect == effect and each.element in elements:
            factor = shown_factor(each.unit)
            sigma = float(spread[index]) * factor
            value = float(model.values[index]) * factor
            rows.append(Size(each.element, each.name, value, sigma, shown_unit(each.unit)))
    return tuple(rows)
