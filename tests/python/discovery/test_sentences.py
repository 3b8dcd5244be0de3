"""One sentence a fitter understands, for every verdict."""

from __future__ import annotations

from dataclasses import replace

import pytest

from hexdbb.discovery import Cause
from hexdbb.discovery.sentences import likely_sentence, verdict_sentence
from hexdbb.discovery.words import place_clause
from hexdbb.evidence.fit.heldout import HeldOut
from hexdbb.learned import ALL, Learned, periodic, step
from hexdbb.learned import variables as v

PLAY = Cause(
    choice="backlash:4",
    effect="backlash",
    elements=("4",),
    verdict="effect",
    share=0.99,
    margin=100.0,
    form_deviation=0.0,
    refinements=(),
    function="learned:slider:4:direction",
    alike=(),
    rivals=(),
    values=(),
    clause="slider 4 has 15.0 ± 0.1 µm of play between drive and carriage",
)
DENT = replace(PLAY, choice="learned:slider:5:position", verdict="unknown", clause="slider 5 along its guideway: a dip")
UNSEEN = {name: HeldOut(3.0, 0.5, 0.99, 0.5, 0.5) for name in ("circle", "feed", "direction")}


def test_a_known_cause() -> None:
    assert verdict_sentence("effect", [PLAY], 0.99, UNSEEN) == (
        "Slider 4 has 15.0 ± 0.1 µm of play between drive and carriage; it explains 99 % of what the model missed, on"
        " circles, feeds and directions not used to find it"
    )


def test_a_cause_that_cannot_be_told_from_another() -> None:
    rival = replace(PLAY, verdict="ambiguous", rivals=("reversal_spike:4",))
    said = verdict_sentence("ambiguous", [rival], 0.99, {})
    assert said.endswith(
        "carriage, or these readings do not tell it from reversal_spike:4; it explains 99 % of what the model missed"
    )


def test_of_many_rivals_the_best_are_named() -> None:
    rivals = ("screw_thermal:1", "bar_drift", "learned:cup:fine_time", "learned:ball:time", "learned:leg:1:time")
    said = verdict_sentence("ambiguous", [replace(PLAY, verdict="ambiguous", rivals=rivals)], 0.99, {})
    assert "do not tell it from screw_thermal:1, bar_drift, learned:cup:fine_time and 2 more; it explains" in said


def test_a_learned_cause_alone_and_beside_a_known_one() -> None:
    assert verdict_sentence("unknown", [DENT], 0.86, {}) == (
        "something is missing that no known effect explains: slider 5 along its guideway: a dip; it explains 86 % of"
        " what the model missed"
    )
    assert verdict_sentence("effect", [PLAY, DENT], 1.0, {}) == (
        "Slider 4 has 15.0 ± 0.1 µm of play between drive and carriage; beside it something that no known effect"
        " explains: slider 5 along its guideway: a dip; together they explain 100 % of what the model missed"
    )


def test_what_does_not_predict_is_not_said_to() -> None:
    assert verdict_sentence("unknown", [PLAY], 0.99, UNSEEN) == (
        "something is missing that known effects explain in part only, or do not predict: slider 4 has 15.0 ± 0.1 µm of"
        " play between drive and carriage; it explains 99 % of what the model missed"
    )
    assert "not used to find it" in verdict_sentence("unknown", [DENT], 0.99, UNSEEN)


def test_the_likely_cause() -> None:
    assert likely_sentence([PLAY], 0.99, {}).startswith("likely cause: slider 4 has 15.0 ± 0.1 µm of play")
    assert likely_sentence([DENT], 0.99, {}).startswith("likely cause: no known effect, slider 5 along its guideway")
    both = likely_sentence([PLAY, DENT], 0.99, {})
    assert both.startswith("likely causes: slider 4 has") and "; and no known effect, slider 5" in both


@pytest.mark.parametrize(
    ("hypothesis", "clause"),
    [
        (
            Learned("cup", ALL, step((295.2, 646.0))),
            "cup: shifts at 295 s and 646 s",
        ),
        (
            Learned("reading", ALL, periodic("time", 0.5021)),
            "reading of the gauge: repeats every 0.5021 s",
        ),
        (
            Learned("slider", 2, v.FINE_TIME),
            "slider 2 along its guideway: follows the fine time",
        ),
        (Learned("leg", ALL, v.YAW), "length of all legs: follows the yaw"),
        (
            Learned.parse("learned:cup:growth_settling@472.1"),
            "cup: creeps towards an end within about 472 s",
        ),
    ],
)
def test_a_place_and_its_variable_in_words(hypothesis: Learned, clause: str) -> None:
    assert place_clause(hypothesis) == clause
