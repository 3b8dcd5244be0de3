"""Values whose size the readings determine and whose sign they do not.

Horizontal circles see the cup's height to second order only: off by d it shortens the bar by d^2 / (2 L), above or
below alike, so that a fit may end on either side. Every value of the set-up that stands clear of zero is therefore
fitted again from the opposite sign: the better of the two solutions is kept, and where the readings hardly prefer one,
the value does not count as identifiable.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hexdbb import _core
from hexdbb.model import Model, Parameter
from hexdbb.units import readable_unit, shown_factor, shown_unit

CLEAR_OF_ZERO = 2.0
"""Stated standard deviations above which a value has a sign: below, the other sign is within its uncertainty."""
HARDLY_PREFERRED = 9.0
"""Difference of twice the log-posterior below which neither sign is preferred: three standard deviations, squared."""

Fit = Callable[[Model], tuple[Model, _core.FitResult]]
Fitted = tuple[Model, _core.FitResult]


def settle_signs(fitted: Fitted, fit: Fit, noise_mm: float) -> tuple[Fitted, list[str]]:
    """Fit again from the other sign of each value of the set-up that has one, and keep the better solution.

    Parameters
    ----------
    fitted : tuple of Model and engine result
        A first solution.
    fit : callable
        Fits again from a start.
    noise_mm : float
        Of one reading.

    Returns
    -------
    fitted : tuple
        The best solution found; values of either sign have no sigma in it.
    said : list of str
        One sentence for each such value.
    """
    said: list[str] = []
    unsure: list[int] = []
    for column in _signed(*fitted):
        model = fitted[0]
        turned = model.values.copy()
        turned[column] *= -1.0
        other = fit(model.with_values(turned))
        if other[0].values[column] * model.values[column] > 0.0:
            continue
        gain = _cost(*fitted, noise_mm) - _cost(*other, noise_mm)
        if abs(gain) < HARDLY_PREFERRED:
            unsure.append(column)
            said.append(_sentence(model.parameters()[column], model.values[column], other[0].values[column]))
        if gain > 0.0:
            fitted = other
    return (_without_sigma(fitted[0], unsure), fitted[1]), said


def _signed(model: Model, result: _core.FitResult) -> list[int]:
    free = set(result.free_columns)
    return [
        column
        for column, (parameter, value, sigma) in enumerate(
            zip(model.parameters(), model.values, model.sigma, strict=True)
        )
        if column in free and parameter.is_set_up and abs(value) > CLEAR_OF_ZERO * sigma
    ]


def _cost(model: Model, result: _core.FitResult, noise_mm: float) -> float:
    prior = ((model.values - model.start) / model.prior_sigma)[result.free_columns]
    return float(np.sum((result.residual_mm / noise_mm) ** 2) + prior @ prior)


def _without_sigma(model: Model, columns: list[int]) -> Model:
    sigma, known = model.sigma, model.identifiable
    sigma[columns], known[columns] = np.nan, False
    return model.with_values(model.values, sigma, known)


def _sentence(parameter: Parameter, one: float, other: float) -> str:
    factor, unit = shown_factor(parameter.unit), readable_unit(shown_unit(parameter.unit))
    return (
        f"{parameter.label} may be {one * factor:+.1f} or {other * factor:+.1f} {unit}:"
        " the readings determine its size, not its sign (a circle in a tilted plane would)"
    )
