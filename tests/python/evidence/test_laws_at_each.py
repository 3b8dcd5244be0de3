"""An effect that all legs share, of another size at each, is by its formula what it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.foreign_records import samples_of

from hexdbb.diagnosis import noise_of
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.fits import fitted
from hexdbb.evidence.fit.formula import left_by_formulas
from hexdbb.evidence.fit.trial import Member, Trial
from hexdbb.evidence.forms.function_at_each import function_at_each
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.search import Search
from hexdbb.learned import Learned, number_of
from hexdbb.learned.following import creeps
from hexdbb.learned.places import EACH
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb.samples.places import with_set_up_of
from hexdbb_truth.forms.cases import case

EFFECTS = ("backlash", "leg_thermal", "pitch_cyclic")


@pytest.fixture(scope="module")
def search() -> Search:
    samples = samples_of("play-beside-growth")
    model = with_set_up_of(samples, new_model(samples.machine))
    return Search(Engine(samples, model, noise_of(samples), DEFAULT), EFFECTS, DEFAULT)


@pytest.fixture(scope="module")
def trial(search: Search) -> Trial:
    known = Known("backlash", ("4",)), Known("leg_thermal", ("1",), True), Known("pitch_cyclic", ("6",))
    return search.trials.of(tuple(map(Member, known)))


def test_forms_stand_beside_each_other(trial: Trial) -> None:
    """Asked before the legs', the form of the play described how the legs differ, by velocity and acceleration."""
    assert trial.left < 1.05
    play = trial.forms[0]
    assert play is not None
    assert not play.is_odd
    assert "learned:slider:4:direction_position" in play.functions


def test_six_sizes_of_one_law_are_no_form(search: Search, trial: Trial) -> None:
    alone = left_by_formulas(trial.forms, search.trials.linear(trial))
    assert alone > 50.0
    assert search.left_by_formulas(trial) < 0.1 * alone
    # Of the others' forms nothing is taken.
    for form in (trial.forms[0], trial.forms[2]):
        linear = search.trials.linear(trial)
        assert form is not None
        assert search.left_by_formula(trial, form) == pytest.approx(left_by_formulas([form], linear))


def test_the_law_is_sought_with_six_sizes_of_it(search: Search) -> None:
    """Legs grew with a time constant of 578 s, unequal by a tenth, beside a play and a pitch error."""
    known = Known("leg_thermal", ("1",), True)
    alone = fitted(search.engine, (Member(known),))
    found = search.trials.forms.laws.with_best_shape(alone, known)
    values = {each.name: value for each, value in zip(found.model.parameters(), found.model.values, strict=True)}
    assert 1800.0 * np.exp(values["log_time"]) == pytest.approx(578.0, rel=0.1)
    assert values["per_time"] > 0.0
    assert "log_time" not in {found.model.parameters()[place].name for place in found.free}


def test_legs_that_grow_alike_keep_their_time_constant() -> None:
    """A law of a time so short that it pushes next to nothing costs no evidence: it was the best of all shapes."""
    samples = Samples.of([case("leg_thermal-d0-x10-calibrate-s66").record()])
    model = with_set_up_of(samples, new_model(samples.machine))
    search = Search(Engine(samples, model, noise_of(samples), DEFAULT), EFFECTS, DEFAULT)
    known = Known("leg_thermal", ("1",), True)
    alone = fitted(search.engine, (Member(known),))
    assert search.trials.forms.laws.with_best_shape(alone, known) is alone
    assert search.trials.of((Member(known),)).left < 1.0


def test_the_law_with_a_size_at_each_is_one_function(search: Search, trial: Trial) -> None:
    form = trial.forms[1]
    assert form is not None
    assert form.law is not None
    assert 0.05 < form.unlike < 0.2  # a tenth, in truth
    function = function_at_each(search.trials.forms.functions, form.law)
    assert (function.place, function.element, function.size) == ("leg", EACH, 6)
    assert creeps(function.variable)
    assert number_of(function.variable) == pytest.approx(578.0, rel=0.1)
    # A law that is none of time stays free in its variable.
    other = replace(form.law, shared=Learned.parse("learned:leg:all:leg_force"))
    assert function_at_each(search.trials.forms.functions, other).name == "learned:leg:each:leg_force"


def test_what_elements_do_not_share_has_no_law(search: Search, trial: Trial) -> None:
    late = Known("sample_delay", ("1",), True)  # one thing for all sliders
    for known in (Known("backlash", ("4",)), Known("pitch_cyclic", ("6",)), late):
        assert search.trials.forms.laws.of(known, trial.model) is None
