"""A known effect and learned functions at one place of the machine: which is the cause, which is its form."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.verdict.one_cause import is_refined, without_borrowed_forms
from hexdbb.learned import Learned

PLAY = Known("backlash", ("2",))
BEND, ELSEWHERE = Learned.parse("learned:slider:2:direction"), Learned.parse("learned:leg:5:velocity")
SPIKE, DECAY = Learned.parse("learned:slider:2:since_reversal_travel"), Learned.parse("learned:slider:2:velocity")
DRIFT = Learned.parse("learned:slider:2:time")
NOTHING = 101.0
"""Mean square that is left where nothing is explained, noise variances."""


def search_of(left: dict[tuple[str, ...], float], refuted: tuple[str, ...] = ()) -> Any:
    """Return a search whose sets leave so much, the best last; some do not predict."""
    hypotheses = {each.name: each for each in (PLAY, BEND, ELSEWHERE, SPIKE, DECAY, DRIFT)}

    def node(names: tuple[str, ...], score: float) -> Any:
        members = tuple(SimpleNamespace(hypothesis=hypotheses[name]) for name in names)
        trial = SimpleNamespace(left=left[names], names=names, refused=())
        of = tuple(hypotheses[name] for name in names)
        return SimpleNamespace(trial=trial, members=members, hypotheses=of, score=score)

    nodes = [node(names, float(score)) for score, names in enumerate(left)]
    by_names = {frozenset(each.trial.names): each.trial for each in nodes}
    return SimpleNamespace(
        nodes=nodes,
        root=SimpleNamespace(trial=SimpleNamespace(left=NOTHING)),
        criteria=DEFAULT,
        kin={PLAY.name: {BEND.name}},
        learnable=SimpleNamespace(by_name={BEND.name: BEND}),
        engine=SimpleNamespace(absent=SimpleNamespace(ports=lambda effect: frozenset({BEND.port}))),
        trials=SimpleNamespace(of=lambda members: by_names[frozenset(each.hypothesis.name for each in members)]),
        checked=lambda each: SimpleNamespace(reasons=each.trial.names if each.trial.names[-1] in refuted else ()),
    )


@pytest.mark.parametrize(
    ("play", "instead", "refuted", "names"),
    [
        (60.0, 2.5, (), (SPIKE.name, DECAY.name)),
        (20.0, 2.5, (), (PLAY.name, SPIKE.name)),
        (60.0, 9.0, (), (PLAY.name, SPIKE.name)),
        (60.0, 2.5, (DECAY.name,), (PLAY.name, SPIKE.name)),
    ],
    ids=["half alone", "nearly all alone", "nothing describes the form", "what describes it does not predict"],
)
def test_play_that_is_part_of_a_spikes_form_is_no_cause(
    play: float, instead: float, refuted: tuple[str, ...], names: tuple[str, ...]
) -> None:
    """Effect and function leave 2.0 of 100, the function alone 15."""
    left = {
        (PLAY.name,): play,
        (SPIKE.name,): 15.0,
        (SPIKE.name, DECAY.name): instead,
        (PLAY.name, SPIKE.name): 2.0,
    }
    search = search_of(left, refuted)
    assert without_borrowed_forms(search, search.nodes[-1]).trial.names == names


def test_play_beside_a_function_of_another_place_stays() -> None:
    left = {
        (PLAY.name,): 60.0,
        (ELSEWHERE.name,): 15.0,
        (ELSEWHERE.name, DECAY.name): 2.5,
        (PLAY.name, ELSEWHERE.name): 2.0,
    }
    search = search_of(left)
    assert without_borrowed_forms(search, search.nodes[-1]).trial.names == (PLAY.name, ELSEWHERE.name)


def test_functions_of_one_place_are_one_cause_unless_one_alone_changes_with_time() -> None:
    left = {
        (SPIKE.name, DECAY.name): 40.0,
        (SPIKE.name, DRIFT.name): 20.0,
        (DECAY.name, DRIFT.name): 60.0,
        (SPIKE.name, DECAY.name, DRIFT.name): 1.0,
    }
    search = search_of(left)
    node = search.nodes[-1]
    assert is_refined(search, node, SPIKE, DECAY)
    assert is_refined(search, node, DECAY, SPIKE)
    assert is_refined(search, node, SPIKE, DRIFT), "a drift that explains less is its form still"
    assert not is_refined(search, node, DRIFT, SPIKE)
