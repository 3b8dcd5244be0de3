"""A function that describes what a known effect's formula leaves is the effect's form, not another cause."""

from __future__ import annotations

from dataclasses import replace

import pytest

from hexdbb import _core
from hexdbb.diagnosis import judging_noise
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.verdict.own_form import with_known_of_form
from hexdbb.evidence.verdict.verdict import Verdict, judge
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case

pytestmark = pytest.mark.long
ALL_OF_IT = 1.1
"""No formula explains that much."""


@pytest.fixture(scope="module")
def searched() -> tuple[Search, Verdict]:
    """A screw whose lead error bends by a fifth: geometry takes most of its straight part; judged without the rule."""
    samples = Samples.of([case("lead_error-d20-x10-judge-s33").record()])
    model = new_model(samples.machine).with_mounts(samples.mounts)
    engine = Engine(samples, model, judging_noise(samples).noise)
    search = Search(engine, _core.effect_names("catalogue"), replace(DEFAULT, formula_most=ALL_OF_IT))
    return search, judge(search)


def test_without_the_rule_the_function_is_named_alone(searched: tuple[Search, Verdict]) -> None:
    _, verdict = searched
    assert [each.hypothesis.name for each in verdict.found] == ["learned:slider:2:position"]
    assert verdict.grade == "unknown"


def test_an_effect_whose_formula_explains_most_has_the_function_as_its_form(searched: tuple[Search, Verdict]) -> None:
    search, verdict = searched
    search.criteria = DEFAULT
    assert verdict.refined is not None
    node, wider = with_known_of_form(search, verdict.node, verdict.refined)
    search.criteria = replace(DEFAULT, formula_most=ALL_OF_IT)
    assert node.trial.names == ("lead_error:2", "learned:slider:2:position")
    assert wider.trial.left < 1.05
    assert search.first_error(node.trial) <= DEFAULT.predicted_to


@pytest.mark.parametrize("formula_most", [0.8, ALL_OF_IT])
def test_what_its_formula_hardly_says_is_no_effect(formula_most: float, searched: tuple[Search, Verdict]) -> None:
    """It says 0.74 of what is missing."""
    search, verdict = searched
    assert verdict.refined is not None
    search.criteria = replace(DEFAULT, formula_most=formula_most)
    assert with_known_of_form(search, verdict.node, verdict.refined) == (verdict.node, verdict.refined)
