"""One test in the habits of many programs: each file gives the values of the source, and says what was detected."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.python.importing.conftest import imported

from hexdbb.record import SLIDER_COLUMNS, Record

MM = {"units": {"reading": "mm"}}
B5R = {**MM, "start_angle_deg": 0.0, "arc_deg": 360.0}
FILES: list[tuple[str, dict[str, Any], float, float, str]] = [
    # file, choices, half a unit of the last printed digit of angle (deg) and reading (µm), what is said
    ("german.csv", {}, 0.0005, 0.05, "cp1252, delimiter semicolon, decimal comma; names in line 4"),
    ("plain.csv", {}, 0.00005, 0.05, 'not read: "operator"'),
    ("wide.csv", {}, 0.05, 0.05, "2 lines after them left out"),
    ("tabs.txt", {}, np.degrees(5e-7), 0.005, "utf-16, delimiter tab"),
    ("spaces.dat", {}, 0.00005, 0.05, "delimiter space, decimal point; no names"),
    ("thousands.csv", {}, 0.005, 0.05, 'time "Zeit in ms" in ms'),
    ("millimetres.csv", {}, 0.0005, 0.005, '"Deviation, mm" in mm'),
    ("mm_as_um.csv", MM, 0.0005, 0.005, "in mm"),
    ("radians_as_degrees.csv", {"units": {"angle": "rad"}}, np.degrees(5e-7), 0.05, "in rad"),
    ("two_tables.csv", {"rows": ((3, 203), (207, 407))}, 0.0005, 0.05, "lines 3-203 and 207-407"),
    ("sliders.csv", {}, 0.00005, 0.05, 's6 "Slider 6 (mm)" in mm'),
    ("merged.xlsx", {}, 0.05, 0.05, 'rows 4-5, 200 rows (rows 6-205); angle "Angle deg" in deg'),
    ("dates.xlsx", {}, 0.0005, 0.05, "Excel, sheet Monday; names in row 1, 402 rows"),
    ("test.b5r", B5R, 0.002, 0.005, "201 + 201 readings in mm, angles as stated, 360° from 0°"),
    ("two_tests.b5r", {"test": 2, "start_angle_deg": 0.0, "arc_deg": 360.0}, 0.002, 0.005, "test 2 of 2"),
]


@pytest.fixture(scope="module")
def records() -> dict[str, tuple[Record, str]]:
    found = {}
    for name, choices, *_ in FILES:
        said: list[str] = []
        found[name] = imported(name, said, **choices), said[0]
        assert len(said) == 1
    return found


def by_direction(record: Record, sign: int) -> tuple[np.ndarray, np.ndarray]:
    """Angle, sorted, and reading of one direction; the turn's last place, passed twice, is left out."""
    chosen = record.columns["direction"] == sign
    angle, reading = record.columns["angle_deg"][chosen][:-1] % 360.0, record.columns["reading_um"][chosen][:-1]
    order = np.argsort(np.round(angle, 1) % 360.0)
    return angle[order], reading[order]


@pytest.mark.parametrize(
    ("name", "choices", "angle_deg", "reading_um", "words"), FILES, ids=[each[0] for each in FILES]
)
def test_values_equal_the_source_within_printed_digits(
    records: dict[str, tuple[Record, str]],
    source: Record,
    name: str,
    choices: dict[str, Any],
    angle_deg: float,
    reading_um: float,
    words: str,
) -> None:
    record, said = records[name]
    assert words in said
    by_place = name in ("wide.csv", "merged.xlsx")
    for sign in (1, -1):
        angle, reading = by_direction(record, sign)
        expected_angle, expected = by_direction(source, sign)
        if by_place:  # a row for each place: nothing is passed twice
            chosen = record.columns["direction"] == sign
            angle, reading = record.columns["angle_deg"][chosen], record.columns["reading_um"][chosen]
            order = np.argsort(angle)
            angle, reading = angle[order], reading[order]
        off = (angle - expected_angle + 180.0) % 360.0 - 180.0
        assert np.abs(off).max() <= angle_deg * (1.0 + 1e-9) + 1e-9
        np.testing.assert_allclose(reading, expected, atol=reading_um * (1.0 + 1e-9))


@pytest.mark.parametrize("name", [each[0] for each in FILES])
def test_a_record_says_what_was_computed(records: dict[str, tuple[Record, str]], name: str) -> None:
    record, _ = records[name]
    computed = record.not_measured
    assert (computed.sliders is None) == (name == "sliders.csv")
    assert (computed.time is None) == (name in ("tabs.txt", "thousands.csv", "sliders.csv", "dates.xlsx"))
    assert record.metadata["imported"]["file"] == name
    assert record.metadata["plan"] == "thesis"


def test_computed_sliders_are_those_of_the_encoders_but_for_the_following_error(
    records: dict[str, tuple[Record, str]], source: Record
) -> None:
    record, _ = records["plain.csv"]
    for name in SLIDER_COLUMNS:
        np.testing.assert_allclose(record.columns[name], source.columns[name], atol=0.01)


def test_measured_sliders_and_times_are_kept(records: dict[str, tuple[Record, str]], source: Record) -> None:
    record, _ = records["sliders.csv"]
    for name in SLIDER_COLUMNS:
        np.testing.assert_allclose(record.columns[name], source.columns[name], atol=0.5001e-4)
    for name in ("tabs.txt", "thousands.csv", "dates.xlsx"):
        times = records[name][0].columns["t_s"]
        np.testing.assert_allclose(times - times[0], source.columns["t_s"] - source.columns["t_s"][0], atol=1e-3)


def test_computed_times_are_those_of_the_feed(records: dict[str, tuple[Record, str]], source: Record) -> None:
    for sweep in (0, 1):
        own, true = (np.diff(r.columns["t_s"][r.columns["sweep"] == sweep]) for r in (records["plain.csv"][0], source))
        np.testing.assert_allclose(own, true, atol=1e-4)


def test_runs_by_place_pass_clockwise_from_the_last_row(records: dict[str, tuple[Record, str]]) -> None:
    for name in ("wide.csv", "merged.xlsx"):
        columns = records[name][0].columns
        steps = np.diff(columns["angle_deg"])
        inside = np.diff(columns["sweep"]) == 0
        assert (np.sign(steps[inside]) == columns["direction"][1:][inside]).all()
        assert columns["lap"].max() == 0


def test_other_columns_are_kept(records: dict[str, tuple[Record, str]]) -> None:
    assert (records["dates.xlsx"][0].columns["temperature_c"] == 20.5).all()
    features = records["test.b5r"][0].metadata["renishaw"]["features"]
    assert [each["name"] for each in features] == ["AF_CIRCULARITY"] * 2
