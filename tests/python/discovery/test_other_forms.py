"""Faults that the catalogue does not have, of forms that no variable was made for; and ball bar or machine."""

from __future__ import annotations

import pytest

from hexdbb.studies.verdicts.cases import line_of
from hexdbb_truth.forms.cases import case


@pytest.mark.parametrize(
    ("name", "learned"),
    [
        ("torque_turns_over-d0-x30-calibrate-s0", "learned:slider:2:acceleration"),
        ("neighbour_disturbs-d0-x10-calibrate-s0", "learned:slider:5:neighbour_velocity"),
        ("joint_seat_warms-d0-x10-calibrate-s0", "learned:platform_joint:4:time"),
    ],
)
def test_it_is_learned_where_it_is(name: str, learned: str) -> None:
    line = line_of(case(name), ())
    assert line["outcome"] == "right"
    assert [each["name"] for each in line["found"]] == [learned]
    before, after = line["left"]
    assert after < 1.1 < before


def test_a_gauge_that_drifts_is_not_put_down_to_legs_for_sure() -> None:
    line = line_of(case("bar_drift-d10-x30-calibrate-s0"), ["bar_drift"])
    assert line["grade"] == "ambiguous"
    (found,) = line["found"]
    assert found["name"] == "leg_thermal"
    assert "learned:reading:time" in found["rivals"]
