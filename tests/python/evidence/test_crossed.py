"""Functions that are looked at last: every state at every place, and products of any two states."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.search import last_resort
from hexdbb.learned import Learned, crossed_hypotheses, further_hypotheses, hypotheses
from hexdbb.studies.verdicts.cases import line_of
from hexdbb_truth.forms.cases import case

LISTED, LAST = "learned:platform_joint:1:leg_force", "learned:slider_joint:1:leg_force"


def stands_before(name: str, left: float, score: float, best_name: str, best_left: float) -> bool:
    """Ask of a single function that leaves so much, in place of another of score 0."""
    last = {each.name for each in crossed_hypotheses()}
    search: Any = SimpleNamespace(
        criteria=DEFAULT, learnable=SimpleNamespace(is_crossed=lambda each: each.name in last)
    )
    node, best = (_node(*each) for each in ((name, left, score), (best_name, best_left, 0.0)))
    return last_resort.stands_before(search, node, best)


def _node(name: str, left: float, score: float) -> Any:
    learned = Learned.parse(name)
    return SimpleNamespace(
        hypotheses=(learned,), members=(learned,), is_known=False, score=score, trial=SimpleNamespace(left=left)
    )


def test_what_is_looked_at_last_is_in_no_list() -> None:
    listed = {each.name for each in (*hypotheses(), *further_hypotheses(), *hypotheses(of_forms=True))}
    last = [each.name for each in crossed_hypotheses()]
    assert not listed & set(last)
    assert len(set(last)) == len(last)
    for place in ("slider", "leg", "lateral", "vertical", "slider_joint", "platform_joint"):
        names = {*listed, *last}
        # Sliders move along the leg's angle as the leg itself does: its functions are the leg's, or the distance's.
        angle = "gap" if place == "slider" else "joint_angle"
        for state in ("position", "velocity", "acceleration", "leg_force", angle, "time", "speed", "angle"):
            assert f"learned:{place}:1:{state}" in names


@pytest.mark.parametrize(
    ("name", "left", "score", "best", "best_left", "expected"),
    [
        (LAST, 1.0, 100.0, LISTED, 2.4, True),  # leaves far less, along fewer axes
        ("learned:cup:deflection", 1.7, 100.0, "learned:reading:deflection", 2.3, False),  # along three, a little less
        ("learned:cup:deflection", 1.1, 100.0, "learned:reading:deflection", 2.3, True),
        ("learned:slider:1:angle", 1.0, 100.0, "learned:platform_joint:1-2:angle", 1.0, True),  # along fewer axes
        ("learned:slider:1:angle", 1.0, 3.0, "learned:platform_joint:1-2:angle", 1.0, False),  # by chance
        ("learned:leg:4:speed_acceleration", 0.95, 100.0, "learned:leg:4:acceleration", 0.96, False),
        (LISTED, 2.3, 1.0, LAST, 2.4, True),  # it is in a list
    ],
)
def test_what_is_looked_at_last_stands_before_what_is_listed_only_where_it_says_more(
    name: str, left: float, score: float, best: str, best_left: float, expected: bool
) -> None:
    assert stands_before(name, left, score, best, best_left) is expected


@pytest.mark.long
@pytest.mark.parametrize(
    ("kind", "found"),
    [
        ("any_sideways_leg_force-d0-x10-judge-s2", "learned:slider_joint:1:leg_force"),
        ("any_upward_joint_rate-d0-x10-judge-s2", "learned:slider_joint:4:turning_rate"),
        ("any_platform_joint_neighbour_velocity-d0-x10-judge-s2", "learned:platform_joint:2:neighbour_velocity"),
    ],
)
def test_a_state_that_no_list_has_at_a_place_is_found_there(kind: str, found: str) -> None:
    line = line_of(case(kind), ())
    assert [each["name"] for each in line["found"]] == [found]
    assert line["left"][1] < 1.1


@pytest.mark.long
@pytest.mark.parametrize(
    ("kind", "found"),
    [
        # Ranked first by the screening, it gave way to functions that had been tuned before.
        ("any_upward_joint_angle-d0-x10-judge-s5", "learned:slider_joint:5:joint_angle"),
        # Play of the slider explains nearly as much, and leaves three noise variances more.
        ("any_upward_travel-d0-x10-judge-s6", "learned:slider_joint:2:since_reversal_travel"),
        # The platform's joint of the leg explains nearly all, along three axes.
        ("any_upward_velocity-d0-x10-judge-s8", "learned:slider_joint:1:velocity_turning@6.782"),
        # The joint's other axes explain nearly all that the slider does, along one.
        ("any_slider_platform_x-d0-x10-judge-s9", "learned:slider:1:platform_x"),
    ],
)
def test_what_is_looked_at_last_is_compared_tuned_and_kept(kind: str, found: str) -> None:
    line = line_of(case(kind), ())
    assert [each["name"] for each in line["found"]] == [found]
    assert line["left"][1] < 1.25


@pytest.mark.long
@pytest.mark.parametrize(
    ("kind", "found"),
    [
        # A tenth of what the function explains, and no form of it.
        (
            "straightness+any_platform_joint_joint_rate-d10-x3,10-calibrate-s702",
            ["straightness:3", "learned:platform_joint:6:turning_rate"],
        ),
        # Of the functions beside the drift the first that was fitted was another place's.
        (
            "bar_drift+any_leg_acceleration-d10-x3,3-calibrate-s707",
            ["bar_drift", "learned:leg:6:acceleration"],
        ),
    ],
)
def test_a_known_effect_and_a_function_are_found_beside_each_other(kind: str, found: list[str]) -> None:
    names = [each["name"].partition("_turning@")[0] for each in line_of(case(kind), ())["found"]]
    assert sorted(names) == sorted(found)
