"""Values that are alike: their prior against that of values on their own."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from hexdbb.evidence.forms.alike import _log_ratio, _prior

Floats = NDArray[np.float64]


def evidence(information: Floats, gradient: Floats, prior: Floats) -> float:
    """Log evidence of a likelihood exp(-z'Az/2 + b'z) under a normal prior, but for a constant of the likelihood."""
    total = information + np.linalg.inv(prior)
    fit = gradient @ np.linalg.solve(total, gradient)
    return 0.5 * float(fit - np.linalg.slogdet(total)[1] - np.linalg.slogdet(prior)[1])


@pytest.mark.parametrize("difference", [0.05, 0.4])
def test_the_ratio_is_that_of_the_evidence_under_either_prior(difference: float) -> None:
    draw = np.random.default_rng(7)
    columns = draw.normal(size=(40, 4))
    information, gradient = columns.T @ columns, columns.T @ draw.normal(size=40) * 3.0
    before, after = np.diag([1.0, 0.25, 1.0, 0.5]), _prior(4, difference)
    spread = np.linalg.inv(information + np.linalg.inv(before))
    ratio = _log_ratio(spread @ gradient, spread, before, after)
    assert ratio == pytest.approx(evidence(information, gradient, after) - evidence(information, gradient, before))


def test_values_that_are_alike_gain_and_others_lose() -> None:
    spread, before, after = np.eye(6) * 0.05**2, np.eye(6), _prior(6, 0.1)
    alike = _log_ratio(np.array([1.0, 0.9, 1.1, 1.05, 0.95, 1.0]), spread, before, after)
    unlike = _log_ratio(np.array([1.0, -0.9, 1.1, -1.05, 0.95, 1.0]), spread, before, after)
    assert alike > 5.0
    assert unlike < -100.0


def test_what_readings_do_not_tell_neither_gains_nor_loses() -> None:
    nearly = np.eye(3) * (1.0 - 1e-9)
    assert _log_ratio(np.zeros(3), nearly, np.eye(3), _prior(3, 0.3)) == pytest.approx(0.0, abs=1e-6)
