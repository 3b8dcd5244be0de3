"""A known effect is fitted beside what the forms of others describe: these are not its to explain."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.diagnosis import judging_noise
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.trial import Member, Trial
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.search import Search
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import Case, case

BOW, SPIKE = Known("straightness", ("1",)), Known("reversal_spike", ("6",))


@pytest.fixture(scope="module")
def hidden() -> Case:
    return case("reversal_spike+straightness-d10-x3,30-calibrate-s911")


@pytest.fixture(scope="module")
def search(hidden: Case) -> Search:
    samples = Samples.of([hidden.record()])
    model = new_model(samples.machine).with_mounts(samples.mounts)
    return Search(Engine(samples, model, judging_noise(samples).noise), (BOW.effect, SPIKE.effect), DEFAULT)


@pytest.fixture(scope="module")
def trial(search: Search) -> Trial:
    search.trials.of((Member(BOW),))
    return search.trials.of((Member(BOW), Member(SPIKE)))


def test_a_spike_beside_a_bow_ten_times_as_large(trial: Trial, hidden: Case) -> None:
    """Beside the bow's formula alone, which leaves 20 times the noise, its height was held at zero."""
    values = zip(trial.model.parameters(), trial.model.values, strict=True)
    spike = SPIKE.effect, SPIKE.elements[0], "height"
    height_mm = next(value for each, value in values if (each.effect, each.element, each.name) == spike)
    true_mm = next(1e-3 * each.size for each in hidden.hidden if each.label.kind == SPIKE.effect)
    assert height_mm == pytest.approx(true_mm, rel=0.2)
    assert trial.left < 1.05


def test_the_formula_keeps_its_size(search: Search, trial: Trial) -> None:
    """The function of a form can say all that the formula does, which then is what explains the most by itself."""
    alone, model = search.trials.of((Member(BOW),)), trial.model
    of_bow = [each.effect == BOW.effect and each.element == "1" for each in model.parameters()]
    before = [each.effect == BOW.effect and each.element == "1" for each in alone.model.parameters()]
    assert np.linalg.norm(model.values[of_bow]) > 0.5 * np.linalg.norm(alone.model.values[before])
