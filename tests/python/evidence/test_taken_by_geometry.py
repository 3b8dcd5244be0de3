"""An effect of which geometry takes nearly all: what is seen of it is its form, at its place and of its size."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.diagnosis import judging_noise
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.trial import Member, Trial
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.verdict.verdict import judge
from hexdbb.learned import Learned
from hexdbb.ledger import add_effect
from hexdbb.model import Model, new_model
from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case

BOWED = "straightness:3"
"""A guideway bowed 20 % off a parabola: ten times the noise is left of it, hundreds before geometry bent after it."""


@pytest.fixture(scope="module")
def samples() -> Samples:
    return Samples.of([case("straightness-d20-x10-calibrate-s31").record()])


@pytest.fixture(scope="module")
def model(samples: Samples) -> Model:
    return new_model(samples.machine).with_mounts(samples.mounts)


def searched(samples: Samples, model: Model, known: tuple[str, ...] = ("straightness",)) -> Search:
    return Search(Engine(samples, model, judging_noise(samples).noise), known, DEFAULT)


@pytest.fixture(scope="module")
def search(samples: Samples, model: Model) -> Search:
    return searched(samples, model)


@pytest.fixture(scope="module")
def trial(search: Search) -> Trial:
    return search.trials.of((Member(Known("straightness", ("3",))),))


def test_its_form_is_at_its_own_place_and_no_larger_than_a_form_may_be(trial: Trial) -> None:
    (form,) = trial.forms
    assert form is not None
    functions = [Learned.parse(name) for name in form.functions]
    assert {each.place for each in functions} <= {"lateral", "vertical", "guideway"}
    assert {each.element for each in functions} == {3}
    assert all(each.variable.column == "sliders_mm" for each in functions)
    assert 0.01 < form.deviation < DEFAULT.form_named
    assert trial.left < DEFAULT.predicted_to


def test_once_it_is_added_its_form_counts_as_what_it_explains(
    samples: Samples, model: Model, search: Search, trial: Trial
) -> None:
    added = searched(samples, add_effect(samples, model, BOWED).model)
    assert added.trials.explained_before > 0.25 * (search.root.trial.left - trial.left)
    assert judge(added).grade == "none"


def test_signatures_about_the_start_have_the_shape_of_another_model(search: Search) -> None:
    engine = search.engine
    table, whose = engine.absent.signatures(engine.start, ("reversal_spike",))
    alike = engine.with_effect(engine.start, "reversal_spike", [whose[0][1]])
    same, of = engine.absent.signatures_about_start("reversal_spike", alike)
    assert of == whose
    np.testing.assert_allclose(same, table, rtol=1e-9, atol=1e-9 * np.abs(table).max())
    shapes = np.array([each.effect == "reversal_spike" and each.is_shape for each in alike.parameters()])
    slower = alike.with_values(np.where(shapes, alike.prior_sigma, alike.values))
    other, _ = engine.absent.signatures_about_start("reversal_spike", slower)
    wanted, _ = engine.absent.signatures(engine.start, ("reversal_spike",), 1.0)
    np.testing.assert_allclose(other, wanted, rtol=1e-9, atol=1e-9 * np.abs(table).max())
    assert np.abs(other - table).max() > 0.01 * np.abs(table).max()
