"""Where sliders reverse: found at the angles at which they were made to, over 0 degrees too, not at starts of runs."""

from __future__ import annotations

import numpy as np
import pytest
from tests.python.comparison.made_up import MakeRecord, compared

from hexdbb.comparison.reversals import reversals
from hexdbb.samples import Samples


def test_reversals_are_found_at_their_angles(make_record: MakeRecord) -> None:
    record = make_record(lambda angle, _: 0.0 * angle, laps=2)
    angle = np.radians(record.columns["angle_deg"])
    record.columns["s4_mm"] = 400.0 + 100.0 * np.sin(angle)
    record.columns["s2_mm"] = 300.0 + 50.0 * np.cos(angle)
    (circle,) = compared([record], [record.reading_mm]).circles
    found = [(each.slider, each.angle_deg) for each in circle.reversals]
    assert [slider for slider, _ in sorted(found)] == [2, 2, 4, 4]
    expected = {(2, 0.0), (2, 180.0), (4, 90.0), (4, 270.0)}
    for slider, at in found:
        nearest = min(abs((at - deg + 180.0) % 360.0 - 180.0) for who, deg in expected if who == slider)
        assert nearest < 1.0
    assert found == sorted(found, key=lambda each: each[1])


def test_what_happens_in_one_lap_of_many_is_none(make_record: MakeRecord) -> None:
    record = make_record(lambda angle, _: 0.0 * angle, laps=4)
    step = np.cumsum(np.ones(len(record)))
    step[200:230] -= 2.0 * np.arange(30)
    record.columns["s1_mm"] = 100.0 + 0.01 * step
    assert reversals(Samples.of([record])) == ()


@pytest.mark.parametrize("directions", [(1,), (-1,)])
def test_one_direction_is_enough(make_record: MakeRecord, directions: tuple[int, ...]) -> None:
    record = make_record(lambda angle, _: 0.0 * angle, directions=directions)
    record.columns["s6_mm"] = 600.0 + 100.0 * np.sin(np.radians(record.columns["angle_deg"]))
    assert [each.slider for each in reversals(Samples.of([record]))] == [6, 6]
