"""Known causes in their exact form: no value that physics does not admit is told."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hexdbb.diagnosis import noise_of
from hexdbb.discovery.causes import is_nothing
from hexdbb.discovery.exact_fit import exactly
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.search import Search
from hexdbb.model import new_model
from hexdbb.record import Record
from hexdbb.samples import Samples
from hexdbb.samples.places import with_set_up_of


def test_play_of_drives_that_have_none_is_never_negative(measured: Callable[[str], Record]) -> None:
    """Slider 4 has play; of the other five some came out a little below zero."""
    samples = Samples.of([measured("backlash-x3-s1")])
    model = with_set_up_of(samples, new_model(samples.machine))
    search = Search(Engine(samples, model, noise_of(samples), DEFAULT), ["backlash"], DEFAULT)
    own = Known("backlash", tuple("123456"), True)
    trial = search.trials.of((Member(own),))
    values = zip(trial.model.parameters(), trial.model.values.tolist(), strict=True)
    free = {each.element: value for each, value in values if each.effect == "backlash"}
    assert min(free.values()) < 0.0
    exact = exactly(search, trial, [own])
    told = exact.values_of(own)
    assert [each.element for each in told] == list("123456")
    assert min(each.value for each in told) == 0.0
    assert max(told, key=lambda each: each.value).element == "4"
    assert all(each.sigma is not None and each.sigma > 0.0 for each in told)  # a held value is no surer than before
    added = exact.model.term("backlash")
    assert added is not None
    assert np.all(added.values >= 0.0)
    assert exact.model.free.sum() == trial.model.free.sum()


def test_a_play_of_nothing_is_no_cause_to_tell(measured: Callable[[str], Record]) -> None:
    """Slider 4 has play; beside a carriage that was pushed aside "slider 2 has 0.0 ± 0.3 µm of play" was told."""
    samples = Samples.of([measured("backlash-x3-s1")])
    model = with_set_up_of(samples, new_model(samples.machine))
    search = Search(Engine(samples, model, noise_of(samples), DEFAULT), ["backlash", "reversal_spike"], DEFAULT)
    play, none, spike = Known("backlash", ("4",)), Known("backlash", ("2",)), Known("reversal_spike", ("2",))
    node = Node(search.trials.of(tuple(map(Member, (play, none, spike)))), 0.0)
    exact = exactly(search, node.trial, [play, none, spike])
    assert not is_nothing(search, node, exact, play)
    assert is_nothing(search, node, exact, none)
    assert is_nothing(search, node, exact, spike)  # whatever its time, which is a shape
