"""What the ball's seat does with each mount of the cup: functions of the bar's direction, as the form of an offset."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hexdbb.evidence.linear.readings import Readings, State
from hexdbb.evidence.linear.signatures import signature_of
from hexdbb.evidence.proposals.learnable import by_mount_of
from hexdbb.learned import Learned
from hexdbb.studies.verdicts.cases import line_of
from hexdbb_truth.forms.cases import case


def with_mounts(readings: Readings, mounts: int) -> Readings:
    columns = {**readings.state._columns, "mount": (np.arange(len(readings)) // 40 % mounts).astype(float)}
    return replace(readings, state=State(columns, readings.state.machine))


def test_a_mount_has_a_function_of_its_own(readings: Readings) -> None:
    some = with_mounts(readings, 3)
    seats = by_mount_of(some)
    assert [each.name for each in seats] == [f"learned:ball:bar_angle_by_mount@{each}" for each in (1, 2, 3)]
    seat = seats[1]
    assert Learned.parse(seat.name) == seat
    assert not seat.is_of_time
    design = signature_of(seat, some).space.design(some.state, 0)
    own, every = np.split(design, 2, axis=1)
    there = some.state["mount"] == 1.0
    assert every.sum(axis=1) == pytest.approx(np.ones(len(some)))
    assert own[there] == pytest.approx(every[there])
    assert not own[~there].any()


@pytest.mark.parametrize(("mounts", "count"), [(1, 0), (2, 1), (4, 4)])
def test_of_two_mounts_one_is_all_but_the_other(readings: Readings, mounts: int, count: int) -> None:
    assert len(by_mount_of(with_mounts(readings, mounts))) == count


def test_a_ball_whose_seat_yields_to_the_bar_is_named_for_sure() -> None:
    """Geometry takes nearly all of where it sits: a fifth of what is left is how its seat yields with one mount."""
    line = line_of(case("ball_eccentricity-d10-x3-judge-s49"), ())
    assert (line["outcome"], line["grade"], line["after_adding"]) == ("right", "effect", "none")
