"""What is kept, or taken once for many, is what would be computed for each."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.diagnosis import judging_noise
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.trial import Member, Trial
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.marginal import marginal
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.linear.sums import Sums
from hexdbb.evidence.search.search import Search
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case


@pytest.fixture(scope="module")
def search() -> Search:
    samples = Samples.of([case("servo_lag-d20-x30-calibrate-s6").record()])
    model = new_model(samples.machine).with_mounts(samples.mounts)
    return Search(Engine(samples, model, judging_noise(samples).noise), ["servo_lag"], DEFAULT, learns=False)


def test_a_linearisation_that_was_dropped_is_made_anew_with_its_forms(search: Search) -> None:
    trials = search.trials
    trial = max((trials.of([Member(Known("servo_lag", (str(leg),)))]) for leg in range(1, 7)), key=_evidence)
    assert any(form is not None and form.columns for form in trial.forms)  # what is 20 % off asks for functions
    kept = trials.linear(trial)
    trials._linear.clear()
    anew = trials.linear(trial)
    assert anew is not kept
    np.testing.assert_allclose(anew.own, kept.own, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(anew.residual, kept.residual, rtol=0.0, atol=1e-6)
    np.testing.assert_allclose(anew.standing, kept.standing, rtol=0.0, atol=1e-6)


def test_what_a_search_released_is_made_anew_the_same(search: Search) -> None:
    learned = search.learnable.simple[0]
    asked = search.screen(search.root).scored(learned), search.trials.linear(search.root.trial)
    search.forget()
    anew = search.screen(search.root).scored(learned), search.trials.linear(search.root.trial)
    assert anew[1] is not asked[1]
    assert anew[0].log_evidence == pytest.approx(asked[0].log_evidence, rel=1e-6)
    np.testing.assert_allclose(anew[1].own, asked[1].own, rtol=1e-9, atol=1e-9)
    assert search.member(anew[0]).factor == pytest.approx(search.member(asked[0]).factor, rel=1e-5)


def test_functions_of_columns_are_released_where_they_are_too_many(
    search: Search, monkeypatch: pytest.MonkeyPatch
) -> None:
    state = search.engine.readings.state
    first, *others = [state.space(each) for each in search.learnable.simple[:12]]
    design = state.design(first, 0)
    assert state.design(first, 0) is design  # kept
    monkeypatch.setattr("hexdbb.evidence.linear.readings.DESIGNS_BYTES", 2.5 * design.nbytes)
    for each in others:
        state.design(each, 0)
    anew = state.design(first, 0)
    assert anew is not design
    np.testing.assert_array_equal(anew, design)


def _evidence(trial: Trial) -> float:
    return trial.log_evidence


def test_functions_ranked_at_once_have_the_evidence_of_each(search: Search) -> None:
    thinned, linear = search.thinned, search.trials.linear(search.root.trial)
    some = search.learnable.simple[::20]
    sizes_mm, temper = np.geomspace(1e-4, 1e-1, 7), 1.3
    found = thinned.log_evidences(some, linear, sizes_mm, temper)
    sums = Sums(thinned.linear(linear), thinned.readings, ())
    for each, evidence in zip(some, found, strict=True):
        signature = thinned.signature(each)
        projected = sums.whole.project(sums.block(signature.table.astype(np.float64)))
        factors = [signature.prior_factor(DEFAULT.ranking_roughness)]
        alone = marginal(projected.information, projected.gradient, factors, sizes_mm, temper=temper)
        assert evidence == pytest.approx(alone.log_evidence, rel=1e-9, abs=1e-6)
