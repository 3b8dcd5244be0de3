"""Whether a model is sufficient: significance and size are two answers, `diagnose` and `discover` give the same."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hexdbb.diagnosis import Diagnosis, JudgingNoise, Noise, assess_sufficiency, diagnose
from hexdbb.discovery import discover
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.cases import case
from hexdbb_truth.plans import PACE

NOISE = JudgingNoise(Noise(0.5e-3, "stated"))


@pytest.fixture(scope="module")
def clean() -> Diagnosis:
    record = case("none-s3", replace(PACE, rate_hz=0.5 * PACE.rate_hz)).record()
    return diagnose(Samples.of([record]), new_model(record.machine), check_held_out=False)


def with_smooth(found: Diagnosis, size_um: float) -> np.ndarray:
    """A residual of white noise, and an oval of this RMS."""
    noise = np.random.default_rng(1).normal(0.0, NOISE.noise.sigma_mm, len(found.samples))
    return noise + np.sqrt(2.0) * size_um * 1e-3 * np.cos(2.0 * found.samples["angle_rad"])


def test_what_is_significant_need_not_matter(clean: Diagnosis) -> None:
    small = assess_sufficiency(clean.samples, clean.model, with_smooth(clean, 0.07), noise=NOISE, matters_um=0.1)
    assert small.is_significant and not small.matters and small.is_sufficient
    assert "significant" in small.sentence and "below the 0.10 µm that matter here" in small.sentence
    large = assess_sufficiency(clean.samples, clean.model, with_smooth(clean, 0.14), noise=NOISE, matters_um=0.1)
    assert large.matters and not large.is_sufficient
    assert large.lack_of_fit.unexplained_um == pytest.approx(0.14, rel=0.15)
    none = assess_sufficiency(clean.samples, clean.model, with_smooth(clean, 0.0), noise=NOISE, matters_um=0.0)
    assert not none.is_significant and none.is_sufficient


def test_what_matters_is_a_part_of_the_noise_and_of_the_error_explained(clean: Diagnosis) -> None:
    found = assess_sufficiency(clean.samples, clean.model, with_smooth(clean, 0.0), noise=NOISE)
    assert found.matters_um == pytest.approx(0.125)
    louder = JudgingNoise(Noise(2e-3, "stated"))
    assert assess_sufficiency(clean.samples, clean.model, clean.residual_mm, noise=louder).matters_um == pytest.approx(
        0.5
    )
    quiet = JudgingNoise(Noise(1e-6, "stated"))
    explained = assess_sufficiency(clean.samples, clean.model, clean.residual_mm, noise=quiet).matters_um
    assert 0.002 < explained < 0.2  # a thousandth of what geometry errors of tenths of a millimetre do to a reading


def test_diagnose_and_discover_give_the_same_answer() -> None:
    record = case("backlash-x3-s1", replace(PACE, rate_hz=0.25 * PACE.rate_hz)).record()
    samples = Samples.of([record])
    diagnosed = diagnose(samples, new_model(record.machine), check_held_out=False)
    assert any(each.startswith("the model lacks something") for each in diagnosed.warnings)
    asked = discover(samples, diagnosed.model)
    assert not diagnosed.sufficiency.is_sufficient and not asked.sufficiency.is_sufficient
    one, other = diagnosed.sufficiency.lack_of_fit, asked.sufficiency.lack_of_fit
    assert one.unexplained_um == pytest.approx(other.unexplained_um, rel=1e-3)
    assert asked.best is not None
    after = diagnose(samples, asked.model, check_held_out=False)
    assert after.sufficiency.is_sufficient and discover(samples, asked.model).verdict == "none"
