"""A fit whose geometry reaches its limits: an effect more leaves no more."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from hexdbb.diagnosis import evaluate_fit, judging_noise
from hexdbb.importing import read_measured
from hexdbb.model import new_model
from hexdbb.samples import Samples

RECORD = Path(__file__).parents[2] / "data" / "foreign" / "play-beside-lead.parquet"


def _cost(samples: Samples, effects: tuple[str, ...]) -> float:
    """Return squares of readings and priors that a fit leaves, in noise variances."""
    noise = judging_noise(samples).noise
    own = [each.effect for each in new_model(samples.machine).terms]
    start = new_model(samples.machine, [*own, *effects]).with_mounts(samples.mounts)
    model, result = evaluate_fit(samples, start, start.free, noise)
    priors = ((model.values - start.start) / start.prior_sigma)[start.free]
    return float(np.sum((result.residual_mm / noise.sigma_mm) ** 2) + priors @ priors)


@pytest.mark.parametrize("effect", ["lead_error", "backlash"])
def test_an_effect_more_leaves_no_more(effect: str) -> None:
    """Play of twenty times the noise on four circles: values on their bounds were never freed, and the fit with leads
    left three times as much as without, and was said to have converged."""
    samples = Samples.of([read_measured(RECORD)])
    assert _cost(samples, (effect,)) <= _cost(samples, ())
