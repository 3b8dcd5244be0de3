"""What is another with each sweep: a step from each sweep to the next, of a tenth of a millimetre at most."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from hexdbb.discovery.words import place_clause
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.linear.readings import Linear, Readings
from hexdbb.evidence.linear.screen import MOST_ANEW_MM, Screen
from hexdbb.evidence.linear.signatures import signature_of
from hexdbb.evidence.linear.sums import Sums
from hexdbb.evidence.linear.thinned import Thinned
from hexdbb.learned import Learned
from hexdbb.learned.listed import crossed_hypotheses, further_hypotheses, hypotheses

ANEW = Learned.parse("learned:cup:each_sweep")


def test_it_is_looked_at_last_at_few_places() -> None:
    places = {each.place for each in crossed_hypotheses() if each.variable.is_anew}
    assert places == {"ball", "cup", "reading", "slider"}
    assert not any(each.variable.is_anew for every in (hypotheses(), further_hypotheses()) for each in every)


def test_each_sweep_has_a_step_and_nothing_is_claimed_of_another(readings: Readings) -> None:
    assert ANEW.is_of_time
    space = signature_of(ANEW, readings).space
    design = space.design(readings.state, 0)
    sweep = readings.state["sweep"]
    assert np.array_equal(design[:, :2], np.column_stack([sweep >= 1, sweep >= 2]))
    assert not design[:, int(sweep.max()) :].any(), "sweeps that the test does not have"


def test_larger_steps_than_anybody_overlooks_are_not_thought_of(
    linear: Linear, readings: Readings, port: Callable[[str], np.ndarray]
) -> None:
    """Steps of two millimetres that nearly cancel would say what a bar does that cools."""
    shift_mm = 20.0 * MOST_ANEW_MM * (readings.state["sweep"] == 1)
    pushed = replace(linear, residual=linear.residual + port("cup")[:, 0] * shift_mm)
    screen = Screen(Sums(pushed, readings, ("circle",)), DEFAULT, Thinned(readings, 200))
    at_instants = Learned.parse("learned:cup:step@11.9/23.9")
    assert screen.scored(ANEW).marginal.size <= MOST_ANEW_MM < screen.scored(at_instants).marginal.size


def test_its_words_are_a_fitters() -> None:
    assert place_clause(ANEW) == "cup: is otherwise with each sweep"
