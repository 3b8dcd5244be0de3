"""Sets of known effects: their evidence against a Gaussian density, and three behind one that imitates them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import logsumexp
from scipy.stats import multivariate_normal

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.linear.readings import Linear, Readings
from hexdbb.evidence.linear.screen import Screen
from hexdbb.evidence.linear.sums import Sums
from hexdbb.evidence.linear.thinned import Thinned
from hexdbb.evidence.search.together import KnownSets, Together

NAMES = ("first", "second", "third", "fourth", "fifth", "imitator")


@pytest.fixture
def signatures(readings: Readings) -> np.ndarray:
    """Six effects of one value each, noise beside what all share; the last is nearly the sum of the first three."""
    draw = np.random.default_rng(11)
    shared = np.sin(np.linspace(0.0, 40.0, len(readings)))[:, None]
    columns = draw.normal(size=(len(readings), 5)) + shared
    return np.column_stack([columns, columns[:, :3].sum(axis=1) + 0.3 * draw.normal(size=len(readings))])


def _sets(linear: Linear, readings: Readings, signatures: np.ndarray) -> tuple[Screen, list[Together]]:
    screen = Screen(Sums(linear, readings, ("circle",)), DEFAULT, Thinned(readings, 240))
    whose = [(name, "1", "value", 1.0) for name in NAMES]
    return screen, KnownSets(screen, [signatures], [whose], set(NAMES), DEFAULT).best(4, 2)


def test_three_that_an_imitator_stands_in_for_are_the_best_set(
    linear: Linear, readings: Readings, signatures: np.ndarray
) -> None:
    hidden = replace(linear, residual=linear.residual + signatures[:, :3].sum(axis=1))
    screen, sets = _sets(hidden, readings, signatures)
    best = max(sets, key=lambda each: each.log_evidence)
    assert {each.known.effect for each in best.members} == {"first", "second", "third"}
    alone = screen.known(signatures, [(name, "1", "value", 1.0) for name in NAMES], set(NAMES))
    assert max(alone, key=lambda each: each.log_evidence).hypothesis.name == "imitator"


def test_the_evidence_is_that_of_the_readings_density(
    linear: Linear, readings: Readings, signatures: np.ndarray
) -> None:
    hidden = replace(linear, residual=linear.residual + signatures[:, 0] - signatures[:, 3])
    screen, sets = _sets(hidden, readings, signatures)
    best = max(sets, key=lambda each: each.log_evidence)
    assert {each.known.effect for each in best.members} == {"first", "fourth"}
    # The noise's variance is that of the screening; the model's own values are told by the readings and have a prior.
    base = screen.temper * np.eye(len(readings)) + screen.temper * hidden.own @ hidden.own.T
    columns = signatures[:, [0, 3]]

    def density(covariance: np.ndarray) -> float:
        return float(multivariate_normal(np.zeros(len(readings)), covariance).logpdf(hidden.residual))

    wide = [density(base + scale**2 * columns @ columns.T) for scale in DEFAULT.catalogue_scale]
    expected = logsumexp(wide) - np.log(len(wide)) - density(base)
    assert best.log_evidence == pytest.approx(expected, rel=1e-6)


def test_nothing_is_put_together_where_one_explains_all(
    linear: Linear, readings: Readings, signatures: np.ndarray
) -> None:
    _, sets = _sets(replace(linear, residual=linear.residual + signatures[:, 4]), readings, signatures)
    assert sets == []


def _of_drives(linear: Linear, readings: Readings, hidden: np.ndarray, one_sided: set[tuple[str, str]]) -> list[str]:
    """Play of six drives, two other effects beside it: the names of the best set where some of them are there."""
    columns = np.random.default_rng(12).normal(size=(len(readings), 8))
    found = replace(linear, residual=linear.residual + columns @ hidden)
    screen = Screen(Sums(found, readings, ("circle",)), DEFAULT, Thinned(readings, 240))
    whose = [
        *(("play", str(k), "size", 1.0) for k in range(1, 7)),
        ("sag", "1", "size", 1.0),
        ("drift", "1", "rate", 1.0),
    ]
    sets = KnownSets(screen, [columns], [whose], {"sag", "drift"}, DEFAULT, one_sided).best(4, 2)
    return sorted(each.known.name for each in max(sets, key=lambda each: each.log_evidence).members)


PLAY = {("play", "size")}


def test_what_is_of_one_sign_stands_at_up_to_three_elements_beside_others(linear: Linear, readings: Readings) -> None:
    hidden = np.array([0.0, 0.0, 0.0, 1.0, 1.1, 0.8, 1.0, 0.0])
    assert _of_drives(linear, readings, hidden, PLAY) == ["play:4", "play:5", "play:6", "sag"]
    assert len(_of_drives(linear, readings, hidden, set())) < 4  # of either sign: one element in larger sets


def test_a_sign_that_cannot_be_is_in_no_set(linear: Linear, readings: Readings) -> None:
    hidden = np.array([-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0])
    assert _of_drives(linear, readings, hidden, PLAY) == ["drift", "sag"]
    assert "play:1" in _of_drives(linear, readings, hidden, set())
