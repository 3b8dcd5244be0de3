"""Whether a verdict is right, and how far: a right effect that is not said for sure is a lead."""

from __future__ import annotations

import pytest

from hexdbb.studies.verdicts import page
from hexdbb.studies.verdicts.outcome import Named, outcome_of
from hexdbb_truth.forms import cases as forms

LABELS = forms.case("backlash-d0-x3-calibrate-s0").labels
PLAY = f"backlash:{LABELS[0].elements[0]}"
OTHER = f"backlash:{LABELS[0].elements[0] % 6 + 1}"


@pytest.mark.parametrize(
    ("grade", "named", "expected"),
    [
        ("effect", [PLAY], "right"),
        ("effect", [OTHER], "element"),
        ("effect", [PLAY, "bar_drift"], "more"),
        ("effect", ["bar_drift"], "false"),
        ("unknown", [PLAY], "lead"),
        ("unknown", [OTHER], "lead"),
        ("unknown", [PLAY, "learned:reading:time"], "more"),
        ("unknown", ["bar_drift"], "missed"),
        ("none", [], "missed"),
    ],
)
def test_an_effect_counts_as_it_is_named(grade: str, named: list[str], expected: str) -> None:
    assert outcome_of(grade, [Named(each, "effect") for each in named], LABELS) == expected


def test_one_of_two_faults_that_is_a_lead_makes_both_one() -> None:
    labels = forms.case("backlash+bar_drift-d0-x3-calibrate-s0").labels
    found = [Named(f"{each.kind}:{','.join(map(str, each.elements))}".rstrip(":"), "effect") for each in labels]
    assert outcome_of("effect", found, labels) == "right"
    assert outcome_of("unknown", found, labels) == "lead"
    assert outcome_of("effect", found[:1], labels) == "missed"
    assert outcome_of("effect", [found[0], Named("gravity_sag", "effect")], labels) == "false"


def test_an_ambiguous_verdict_names_the_truth_or_misses_it() -> None:
    (truth,) = LABELS
    rivals = [f"backlash:{truth.elements[0]}", "bar_gain"]
    assert outcome_of("ambiguous", [Named("bar_drift", "ambiguous", rivals)], LABELS) == "ambiguous"
    assert outcome_of("ambiguous", [Named("bar_drift", "ambiguous", rivals[1:])], LABELS) == "missed"


@pytest.mark.parametrize(
    ("claimed", "expected", "counts"),
    [(["circle"], 1.2, True), (["circle"], 5.4, False), ([], 5.4, True), (["arc", "circle"], 5.4, True)],
    ids=["held", "hardly held", "claims none", "claims arcs first"],
)
def test_only_where_circles_hold_geometry_can_others_be_predicted(
    claimed: list[str], expected: float, counts: bool
) -> None:
    heldout = {"circle": {"expected": expected, "after": 1.0}, "arc": {"expected": 1.0, "after": 1.0}}
    assert page._can_predict({"claimed": claimed, "heldout": heldout}) is counts
