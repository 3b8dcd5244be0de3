"""Values whose size the readings determine and whose sign they do not.

Horizontal circles see the cup's height to second order only: off by d it shortens the bar by d^2 / (2 L), above or
below alike, so that a fit may end on either side. A value of the set-up that stands clear of zero is therefore turned
to the opposite sign, and where the readings do not turn it back, the model is fitted again from there: the better of
the two solutions is kept, and where the readings hardly prefer one, the value does not count as identifiable.

Whether they turn it back follows from one Gauss-Newton step at the turned value x = -c, all other values free, for the
readings that the solution predicts. With the readings' answer to the value a x + b x^2 and q = 2 b c / a, the step ends
at

    c (1 + q) / (1 - q),

at c itself where the answer is linear (q = 0) and at -c where it is even (q infinite). Between c / 2 and 2 c the
quadratic part is less than a third of the linear one (|q| < 1/3): the slope has one sign from -c to c, so that a fit
from -c would come back.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hexdbb import _core
from hexdbb.model import Model, Parameter
from hexdbb.samples import Samples, normal_equations
from hexdbb.units import readable_unit, shown_factor, shown_unit

CLEAR_OF_ZERO = 2.0
"""Stated standard deviations above which a value has a sign: below, the other sign is within its uncertainty."""
HARDLY_PREFERRED = 9.0
"""Difference of twice the log-posterior below which neither sign is preferred: three standard deviations, squared."""
TURNED_BACK = (0.5, 2.0)
"""End of the step from the opposite sign, over the value, between which the readings determine the sign: see above."""
ROWS = 500
"""Evenly spaced readings for that step: 18 for each capture of a plan of seven circles, two directions and two feeds,
where set-up values change the readings by the angle's first harmonics."""

Fit = Callable[[Model], tuple[Model, _core.FitResult]]
Fitted = tuple[Model, _core.FitResult]


def settle_signs(samples: Samples, fitted: Fitted, fit: Fit, noise_mm: float) -> tuple[Fitted, list[str]]:
    """Fit again from the other sign of each value of the set-up whose sign is open, and keep the better solution.

    Parameters
    ----------
    samples : Samples
        What was fitted to.
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
    stride = max(len(samples) // ROWS, 1)
    some = samples.part(np.arange(0, len(samples), stride))
    for column in _signed(*fitted):
        model = fitted[0]
        turned = _turned(model, column)
        if _is_turned_back(some, stride, fitted, turned, column, noise_mm):
            continue
        other = fit(turned)
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


def _turned(model: Model, column: int) -> Model:
    values = model.values.copy()
    values[column] *= -1.0
    return model.with_values(values)


def _is_turned_back(some: Samples, stride: int, fitted: Fitted, turned: Model, column: int, noise_mm: float) -> bool:
    """Return whether a step from the turned value ends near the fitted one: the readings determine its sign.

    `some` is every `stride`-th of the samples.
    """
    model, result = fitted
    free = result.free_columns
    there = normal_equations(some, turned, some.reading_mm - result.residual_mm[::stride])
    if there.failure >= 0:
        return True  # there the machine reaches no such readings at all
    scale, weight = model.prior_sigma[free], stride / noise_mm**2
    away = ((model.values - turned.values)[free]) / scale  # the prior's pull, its centre on the solution
    information = weight * np.outer(scale, scale) * there.information[np.ix_(free, free)] + np.eye(len(free))
    downhill = weight * scale * there.gradient[free] + away
    step = np.linalg.solve(information, downhill)
    place = list(free).index(column)
    end = turned.values[column] + step[place] * scale[place]
    least, most = TURNED_BACK
    return bool(least < end / model.values[column] < most)


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
