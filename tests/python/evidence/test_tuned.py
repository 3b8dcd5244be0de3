"""Functions tuned about the fit of their set."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from hexdbb.diagnosis import judging_noise
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.screen import Screen
from hexdbb.evidence.linear.sums import Sums
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.tuned import around, retunings, with_tuned_numbers
from hexdbb.learned import Learned, periodic
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.cases import case
from hexdbb_truth.plans import PACE
from hexdbb_truth.simulate import simulate

TONE_HZ = 0.31
TONE_UM = 20.0


@pytest.fixture(scope="module")
def search() -> Search:
    """Readings of a machine without a fault, and a tone of forty times their noise."""
    return _search(np.sin)


def _search(tone: Callable[[np.ndarray], np.ndarray]) -> Search:
    clean = case("none-s3", replace(PACE, rate_hz=0.25 * PACE.rate_hz))
    record = simulate(clean.truth, clean.plan, pace=clean.pace)
    tone_um = TONE_UM * tone(2.0 * np.pi * TONE_HZ * record.columns["t_s"])
    record = replace(record, columns={**record.columns, "reading_um": record.columns["reading_um"] + tone_um})
    samples = Samples.of([record])
    return Search(Engine(samples, new_model(record.machine), judging_noise(samples).noise), [], DEFAULT)


def _node(search: Search, learned: Learned) -> Node:
    sums = Sums(search.trials.linear(search.root.trial), search.engine.readings, ("circle",))
    member = search.member(Screen(sums, DEFAULT, search.thinned).scored(learned))
    trial = search.trials.of([member])
    return Node(trial, trial.log_evidence)


def _tone(search: Search, turns_off: float) -> Learned:
    duration_s = float(np.ptp(search.engine.readings.state["time_s"]))
    return Learned("reading", 0, periodic("time", 1.0 / (TONE_HZ + turns_off / duration_s)))


@pytest.mark.parametrize("turns_off", [-0.1, 0.05])
def test_a_period_is_moved_to_the_readings_own(search: Search, turns_off: float) -> None:
    node = _node(search, _tone(search, turns_off))
    tuned = with_tuned_numbers(search, node)
    (found,) = tuned.hypotheses
    assert isinstance(found, Learned)
    duration_s = float(np.ptp(search.engine.readings.state["time_s"]))
    assert 1.0 / found.variable.period == pytest.approx(TONE_HZ, abs=0.01 / duration_s)
    assert tuned.trial.left < 1.2 < 3.0 < node.trial.left
    assert found in search.learnable.by_name.values()


def test_what_a_function_explains_is_what_a_set_without_it_leaves(search: Search) -> None:
    node = _node(search, _tone(search, 0.0))
    without = around(search, node, node.members[0])
    rms = float(np.sqrt(np.mean(without.residual**2)))
    assert rms * search.engine.noise.sigma_mm * 1e3 == pytest.approx(TONE_UM / np.sqrt(2.0), rel=0.05)
    assert without.own.shape[1] == search.trials.linear(search.root.trial).own.shape[1]


@pytest.mark.parametrize(("sharpness", "least", "most"), [(8.0, 32, 64), (20.0, 64, 128)])
def test_a_sharp_function_gets_more_splines(sharpness: float, least: int, most: int) -> None:
    search = _search(lambda turn: np.tanh(sharpness * np.sin(turn)))
    node = _node(search, _tone(search, 0.0))
    best = next(retunings(search, node, node.members[0]))
    assert isinstance(best.hypothesis, Learned)
    assert best.hypothesis.name == node.members[0].hypothesis.name
    assert least <= best.hypothesis.variable.count <= most
    assert search.trials.of([best]).left < 1.1 < 2.0 < node.trial.left
