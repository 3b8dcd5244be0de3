"""What an effect at all its elements gains where its values are alike: drives of one make, screws of one batch.

The fit knows of its values only that each has its prior. That they differ little from one another is itself a prior: a
common value with that of each, and differences of a part of it. The evidence under it is the posterior's mean of the
ratio of the two priors, which is in closed form where both are normal.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.forms.form_functions import diagonal
from hexdbb.evidence.linear.engine import Fitted
from hexdbb.evidence.linear.physical import is_one_sided
from hexdbb.evidence.linear.readings import Linear
from hexdbb.evidence.linear.screen import Known
from hexdbb.learned import Learned

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

DIFFERENCES = (0.1, 0.3)
"""Standard deviations of the differences over the common value: parts of one batch agree to about a tenth; with wear
and mountings of their own they differ by up to a third (0.84 to 1.19 times on another simulator)."""
LEAST_DIFFERENCE = 1e-3
"""The same in prior standard deviations, at least: values that are nothing are not alike beyond what readings tell."""


def gained_alike(linear: Linear, fitted: Fitted, hypotheses: Sequence[Known | Learned]) -> float:
    """Return the log evidence that effects at all their elements gain by the priors under which they are alike.

    Parameters
    ----------
    linear : Linear
        About the most probable values, forms beside them.
    fitted : Fitted
    hypotheses : sequence of Known or Learned

    Returns
    -------
    float
        Of the even mixture of both priors over the prior of values on their own.
    """
    every = [each for each in hypotheses if isinstance(each, Known) and each.is_whole and len(each.elements) > 1]
    if not every:
        return 0.0
    covariance = np.asarray(np.linalg.inv(linear.normal[:-1, :-1] + np.eye(len(linear.standing))), np.float64)
    return float(sum(_gained(linear, covariance, fitted, each) for each in every))


def _gained(linear: Linear, covariance: Floats, fitted: Fitted, known: Known) -> float:
    """Return the same of one effect."""
    values = _values_of(fitted, known)
    at = np.concatenate(list(values.values()))
    # Where a value is large, the fit widened its prior: here all are in the largest standard deviation of their kind.
    unit = np.concatenate([fitted.prior_sigma[each] / fitted.prior_sigma[each].max() for each in values.values()])
    standing, spread = linear.standing[at] * unit, covariance[np.ix_(at, at)] * np.outer(unit, unit)
    info, one_sided = fitted.model.info(known.effect), 0.0
    blocks: dict[float, list[Floats]] = defaultdict(list)
    for name, places in values.items():
        kind = np.isin(at, places)
        is_shape = any(each.name == name and each.is_shape for each in info.parameters)
        common = 1.0 if is_shape else abs(float(np.mean(standing[kind])))
        one_sided += (len(places) - 1) * np.log(2.0) if is_one_sided(info, name) else 0.0
        for part in DIFFERENCES:
            blocks[part].append(_prior(len(places), max(part * common, LEAST_DIFFERENCE)))
    ratios = [_log_ratio(standing, spread, np.diag(unit**2), diagonal(each)) for each in blocks.values()]
    alike = np.logaddexp.reduce(ratios) - np.log(len(ratios)) - one_sided
    return float(np.logaddexp(alike, 0.0) - np.log(2.0))


def _values_of(fitted: Fitted, known: Known) -> dict[str, Ints]:
    """Return the places of an effect's values among the free ones, by name."""
    parameters = fitted.model.parameters()
    found: dict[str, list[int]] = defaultdict(list)
    for place, column in enumerate(fitted.free):
        if parameters[column].effect == known.effect:
            found[parameters[column].name].append(place)
    return {name: np.array(places) for name, places in found.items()}


def _prior(number: int, difference: float) -> Floats:
    """Return the covariance of values that share one of unit variance."""
    return np.ones((number, number)) + difference**2 * np.eye(number)


def _log_ratio(mean: Floats, spread: Floats, before: Floats, after: Floats) -> float:
    """Return the log of the evidence under one normal prior about zero over that under another.

    Parameters
    ----------
    mean : ndarray, shape (n,)
        Of the posterior under the prior `before`.
    spread : ndarray, shape (n, n)
        Its covariance.
    before, after : ndarray, shape (n, n)
        Covariances of the priors.
    """
    inverse = np.linalg.inv(spread)
    information = inverse - np.linalg.inv(before) + np.linalg.inv(after)
    towards = inverse @ mean
    fit = towards @ np.linalg.solve(information, towards) - mean @ towards
    return 0.5 * float(fit + _log_det(before) - _log_det(after) - _log_det(spread) - _log_det(information))


def _log_det(matrix: Floats) -> float:
    return float(np.linalg.slogdet(matrix)[1])
