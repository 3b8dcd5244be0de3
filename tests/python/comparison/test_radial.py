"""Radial error of the commanded circles: what it takes out, what it keeps, and how a compensated record is shown."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console
from tests.python.comparison.made_up import MakeRecord, compared

from hexdbb.comparison.tables import comparison_text
from hexdbb.record import Record


def offset(angle: np.ndarray, direction: int) -> np.ndarray:
    """What a perfect circle reads about a cup that is off by (0.3, -0.2) mm in its plane."""
    return np.hypot(100.0 * np.cos(angle) - 0.3, 100.0 * np.sin(angle) + 0.2) - 100.0


def nothing(record: Record) -> np.ndarray:
    return np.zeros(len(record))


def text_of(comparison: object) -> str:
    console = Console(width=200)
    with console.capture() as captured:
        console.print(comparison_text(comparison))
    return captured.get()


def test_the_set_up_is_taken_out_and_nothing_else(make_record: MakeRecord) -> None:
    # 5 um too large, 8 um of ellipse, 3 um of lost motion: none of it is a centre.
    made = make_record(lambda a, d: offset(a, d) + 0.005 + 0.008 * np.cos(2 * a) + 0.0015 * d)
    (radial,) = compared([made], [nothing(made)]).radial
    expected = np.sqrt(0.005**2 + 0.008**2 / 2.0 + 0.0015**2)
    assert radial.rms_mm == pytest.approx(expected, rel=0.01)
    assert radial.peak_to_valley_mm == pytest.approx(0.016 + 0.003, rel=0.01)


def test_a_set_up_alone_leaves_nothing(make_record: MakeRecord) -> None:
    made = make_record(offset)
    (radial,) = compared([made], [nothing(made)]).radial
    assert radial.rms_mm == pytest.approx(0.0, abs=1e-9)


def test_no_model_changes_it(make_record: MakeRecord) -> None:
    made = make_record(lambda a, d: 0.004 * np.cos(3 * a))
    one, other = (compared([made], [predicted]).radial for predicted in (nothing(made), made.reading_mm))
    assert one == other


def test_every_circle_has_a_centre_of_its_own_and_the_worst_is_named(make_record: MakeRecord) -> None:
    made = make_record(lambda a, d: 0.004 * np.cos(2 * a), circles=2)
    second = made.columns["circle"] == 1
    larger = made.columns["reading_um"] * np.where(second, 3.0, 1.0)
    larger += np.where(second, 20.0 * np.cos(np.radians(made.columns["angle_deg"])), 0.0)
    made = replace(made, columns=made.columns | {"reading_um": larger})
    (radial,) = compared([made], [nothing(made)]).radial
    assert radial.worst_circle == 1
    assert radial.peak_to_valley_mm == pytest.approx(0.024, rel=0.01)


def test_without_a_full_circle_there_is_none(make_record: MakeRecord) -> None:
    made = make_record(offset)
    made = made.part(made.columns["angle_deg"] < 200.0)
    comparison = compared([made], [nothing(made)])
    assert comparison.radial[0].rms_mm is None
    assert comparison.to_json()["radial"][0]["rms_um"] is None
    assert "Radial error of the commanded circles: - (no full circle)" in text_of(comparison)


def test_a_compensated_record_says_so_beside_one_that_is_not(make_record: MakeRecord) -> None:
    before = make_record(lambda a, d: 0.030 * np.cos(2 * a), path=Path("before.parquet"))
    after = make_record(lambda a, d: 0.001 * np.cos(2 * a), path=Path("after.parquet"))
    after.metadata["compensation"] = {"file": "sp120.hexcomp"}
    comparison = compared([before, after], [nothing(before), nothing(after)])
    assert [each.compensation for each in comparison.radial] == [None, "sp120.hexcomp"]
    text = text_of(comparison)
    assert "of before.parquet: 21.21 µm RMS" in text
    assert "of after.parquet, compensated by sp120.hexcomp: 0.71 µm RMS" in text
    assert "the radial error tests machine and compensation" in text
