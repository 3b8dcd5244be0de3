"""Comparison of records with predictions whose difference is known."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console
from tests.python.comparison.made_up import MakeRecord, compared

from hexdbb.comparison import QUANTITIES
from hexdbb.comparison.tables import comparison_text
from hexdbb.errors import InputError
from hexdbb.record import Record


def three_lobes(angle_rad: np.ndarray, direction: int) -> np.ndarray:
    return 0.010 * np.cos(3 * angle_rad) + 0.002 * direction


def rows(record: Record, **wanted: float) -> np.ndarray:
    return np.all([record.columns[name] == value for name, value in wanted.items()], axis=0)


def test_measured_quantities_of_a_known_shape(make_record: MakeRecord) -> None:
    record = make_record(three_lobes, laps=2)
    (circle,) = compared([record], [np.zeros(len(record))]).circles
    ccw, cw = circle.directions
    assert (ccw.direction, cw.direction) == (1, -1)
    expected_mm = {
        "circular_deviation": 0.020,
        "bidirectional_circular_deviation": 0.024,
        "circular_hysteresis": 0.004,
        "mean_bidirectional_radial_deviation": 0.0,
        "radial_deviation_max": 0.012,
        "radial_deviation_min": -0.008,
        "radial_deviation_max_with_offset": 0.012,
        "radial_deviation_min_with_offset": -0.008,
    }
    assert dict(ccw.measured_quantities) == pytest.approx(expected_mm, abs=1e-7)
    assert set(expected_mm) == {quantity.key for quantity in QUANTITIES}
    assert cw.measured_quantities["radial_deviation_min"] == pytest.approx(-0.012, abs=1e-7)
    assert max(abs(value or 0.0) for value in ccw.predicted_quantities.values()) < 1e-9


def test_a_perfect_prediction_leaves_nothing(make_record: MakeRecord) -> None:
    record = make_record(three_lobes, circles=2, feeds=(753.98, 3000.0))
    comparison = compared([record], [record.reading_mm])
    assert comparison.rms_mm == comparison.peak_to_valley_mm == 0.0
    assert len(comparison.circles) == 4
    for circle in comparison.circles:
        for part in circle.directions:
            assert part.measured_quantities == part.predicted_quantities


def test_residual_is_measured_minus_predicted(make_record: MakeRecord) -> None:
    record = make_record(three_lobes)
    predicted_mm = record.reading_mm - 0.001 * record.columns["direction"] - 0.003
    comparison = compared([record], [predicted_mm])
    ccw, cw = comparison.circles[0].directions
    assert ccw.residual_mm == pytest.approx(np.full(len(ccw.rows), 0.004))
    assert cw.residual_mm == pytest.approx(np.full(len(cw.rows), 0.002))
    assert comparison.rms_mm == pytest.approx(np.sqrt((0.004**2 + 0.002**2) / 2.0))
    assert comparison.peak_to_valley_mm == pytest.approx(0.002)
    assert np.array_equal(record.columns["direction"][cw.rows], np.full(len(cw.rows), -1))


def test_the_worst_place_is_named(make_record: MakeRecord) -> None:
    record = make_record(three_lobes, circles=3, feeds=(753.98, 3000.0), laps=2)
    angle_deg = record.columns["angle_deg"]
    bump = rows(record, circle=2, direction=-1, feed_mm_min=3000.0) & (angle_deg >= 120.0) & (angle_deg < 130.0)
    comparison = compared([record], [record.reading_mm - 0.005 * bump])
    worst = comparison.worst[0]
    assert worst.where == "circle 2, clockwise, 3000 mm/min, angle 120-130 deg"
    assert worst.rms_mm == pytest.approx(0.005)
    assert [place.rms_mm for place in comparison.worst[1:]] == [0.0] * (len(comparison.worst) - 1)


def test_several_records_are_told_apart(make_record: MakeRecord) -> None:
    monday, tuesday = (make_record(three_lobes, path=Path(day) / "demo.parquet") for day in ("monday", "tuesday"))
    comparison = compared([monday, tuesday], [monday.reading_mm, tuesday.reading_mm - 0.001])
    assert comparison.worst[0].where.startswith("tuesday/demo.parquet, circle 0, ")
    assert {circle.record_name for circle in comparison.circles} == {"monday/demo.parquet", "tuesday/demo.parquet"}
    renamed = replace(tuesday, path=Path("other.csv"))
    names = [circle.record_name for circle in compared([monday, renamed], [monday.reading_mm] * 2).circles]
    assert names == ["demo.parquet", "other.csv"]


def test_a_circle_off_the_bar_length_counts_from_its_own_radius(make_record: MakeRecord) -> None:
    """At radius 99.8 mm a 100 mm bar reads -200 um on the nominal path."""
    record = make_record(lambda angle, _: np.full_like(angle, -0.195), radius_mm=99.8)
    ccw = compared([record], [record.reading_mm]).circles[0].directions[0]
    assert ccw.measured_quantities["mean_bidirectional_radial_deviation"] == pytest.approx(0.005, abs=1e-9)


def test_json_has_the_stated_shape(make_record: MakeRecord) -> None:
    record = make_record(three_lobes, feeds=(753.98, 3000.0))
    text = json.dumps(compared([record], [record.reading_mm - 0.001]).to_json(), allow_nan=False)
    found = json.loads(text)
    assert found["rms_um"] == pytest.approx(1.0)
    assert found["peak_to_valley_um"] == pytest.approx(0.0, abs=1e-9)
    assert [(c["circle"], c["feed_mm_min"], c["direction"]) for c in found["circles"]] == [
        (0, 753.98, 1),
        (0, 753.98, -1),
        (0, 3000.0, 1),
        (0, 3000.0, -1),
    ]
    first = found["circles"][0]
    assert first["rms_um"] == pytest.approx(1.0)
    assert first["circular_deviation_um"] == pytest.approx(20.0, abs=1e-4)
    assert set(first["predicted"]) == {f"{quantity.key}_um" for quantity in QUANTITIES}
    assert first["predicted"]["mean_bidirectional_radial_deviation_um"] == pytest.approx(-1.0, abs=1e-4)
    assert set(found["worst"][0]) == {"where", "rms_um"}


def test_what_cannot_be_evaluated_is_null(make_record: MakeRecord) -> None:
    record = make_record(three_lobes)
    columns = record.columns
    cut = (columns["direction"] == 1) | (columns["angle_deg"] > 200.0)
    short = replace(record, columns={name: values[cut] for name, values in columns.items()})
    comparison = compared([short], [short.reading_mm])
    ccw, cw = comparison.to_json()["circles"]
    assert ccw["circular_deviation_um"] == pytest.approx(20.0, abs=1e-4)
    assert ccw["bidirectional_circular_deviation_um"] is None
    assert cw["circular_deviation_um"] is None
    assert cw["rms_um"] == 0.0
    console = Console(width=80, highlight=False, color_system=None)
    with console.capture() as capture:
        console.print(comparison_text(comparison))
    assert "-: cannot be evaluated" in capture.get()


def test_text_fits_eighty_columns_and_states_everything(make_record: MakeRecord) -> None:
    record = make_record(three_lobes, circles=2, feeds=(753.98, 3000.0))
    predicted_mm = record.reading_mm - 0.001 * rows(record, circle=1)
    console = Console(width=80, highlight=False, color_system=None)
    with console.capture() as capture:
        console.print(comparison_text(compared([record], [predicted_mm])))
    text = capture.get()
    assert "…" not in text
    assert max(len(line.rstrip()) for line in text.splitlines()) <= 80
    assert "ISO 230-4:2005" in text
    for quantity in QUANTITIES:
        assert f"{quantity.symbol}: {quantity.name}" in text
    assert "1.00 µm RMS  circle 1, counter-clockwise, 753.98 mm/min, angle " in text


def test_a_prediction_that_does_not_belong_is_refused(make_record: MakeRecord) -> None:
    record = make_record(three_lobes)
    with pytest.raises(InputError, match=r"demo\.parquet: prediction of shape \(3,\) \(expected .*\(1440,\)"):
        compared([record], [np.zeros(3)])
    broken = record.reading_mm.copy()
    broken[7] = np.nan
    with pytest.raises(InputError, match=r"demo\.parquet: predicted reading of sample 7 is nan"):
        compared([record], [broken])
    empty = replace(record, columns={name: values[:0] for name, values in record.columns.items()})
    with pytest.raises(InputError, match="no samples"):
        compared([empty], [np.zeros(0)])
