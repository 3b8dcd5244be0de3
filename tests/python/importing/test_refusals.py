"""What cannot be read as it stands is refused in one line that names the place, the value and the option."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.python.importing.conftest import FOLDER, imported, refusal

import hexdbb.importing.foreign as foreign

CIRCLE = [(float(angle), 10.0 * np.sin(np.radians(3.0 * angle))) for angle in range(0, 360, 5)]
HEAD = "Angle (deg),Deviation (um)"
ROWS = [f"{angle:g},{reading:.2f}" for angle, reading in CIRCLE]


def changed(rows: list[str], place: int, row: str) -> list[str]:
    return [*rows[:place], row, *rows[place + 1 :]]


@pytest.mark.parametrize(
    ("name", "choices", "message"),
    [
        ("german.csv", {"plan": None}, "german.csv: which circle was driven is not stated (expected --plan PLAN"),
        (
            "german.csv",
            {"plan": "standard"},
            "german.csv: which circle of standard is not stated (expected --circle 0,",
        ),
        ("german.csv", {"plan": "standard", "circle": 7}, "german.csv: circle: 7 (expected the id of a circle"),
        ("german.csv", {"plan": "standard", "circle": 0}, "the feed is not stated; standard has 753.98, 3000 mm/min"),
        ("german.csv", {"encoding": "utf-8"}, "german.csv: byte 18 is not utf-8 (expected text"),
        ("german.csv", {"encoding": "latin-99"}, 'german.csv: encoding: "latin-99" (expected one that Python has'),
        ("german.csv", {"columns": {"angle": "Ort"}}, 'column angle: "Ort" is not there (expected one of "Winkel [°]"'),
        ("german.csv", {"columns": {"angle": 9}}, "column angle: 9 (expected at most 3, the number of columns)"),
        ("german.csv", {"rows": ((5, 900),)}, "german.csv: line 900 is not there (expected one up to 406"),
        (
            "german.csv",
            {"rows": ((1, 30),)},
            "german.csv: line 1: holds no number (expected readings, as --rows states)",
        ),
        ("mm_as_um.csv", {}, "readings span 0.246 µm only (expected 1 at least, of a circle); they look like mm"),
        ("german.csv", {"units": {"reading": "m"}}, "row 1 (line 5): reading_um:"),
        ("radians_as_degrees.csv", {}, "angles span 6.283°, as radians of a whole turn would (expected a whole turn;"),
        ("two_tables.csv", {}, "two_tables.csv: 2 tables, lines 3-203 and 207-407 (expected one; one of --rows 3:203"),
        ("bad_cell.csv", {}, 'bad_cell.csv: line 119: column "Deviation (um)": "#REF!" (expected a number)'),
        ("dates.xlsx", {"sheet": "Tuesday"}, 'dates.xlsx: sheet: "Tuesday" (expected one of "Notes", "Monday")'),
        ("test.b5r", {}, "BALLBAR_RUN 1: READINGS: no unit is stated; values up to 0.1515 (expected --unit reading="),
        ("test.b5r", {"units": {"reading": "mm"}}, "BALLBAR_RUN 1: READINGS: no angles are stated (expected --start-"),
        ("test.b5r", {"plan": "standard", "circle": 0, "feed_mm_min": 1.0}, "READINGS: no unit is stated"),
        ("two_tests.b5r", {}, "two_tests.b5r: holds 2 tests, 1: first, 2: second (expected --test"),
        ("two_tests.b5r", {"test": 3}, "two_tests.b5r: test 3 is not there (expected one of 1: first, 2: second)"),
    ],
)
def test_files_are_refused_in_one_line(name: str, choices: dict[str, Any], message: str) -> None:
    assert message in refusal(name, **choices)


@pytest.mark.parametrize(
    ("lines", "choices", "message"),
    [
        ([HEAD, *ROWS[:5]], {}, "no table of readings (expected 8 rows at least of two numbers each"),
        ([], {}, "no table of readings"),
        ([HEAD, *changed(ROWS, 40, "200,")], {}, 'line 42: column 2: an empty cell (expected a number)'),
        ([HEAD, *changed(ROWS, 71, "355,n/a")], {}, 'line 73: column 2: "n/a" (expected a number)'),
        ([HEAD, *changed(ROWS, 7, "35,nan")], {}, 'line 9: column 2: "nan"'),
        ([HEAD, *changed(ROWS, 30, "01.02.2026,3.1")], {}, '"01.02.2026" (expected a number)'),
        ([HEAD, *changed(ROWS, 30, '"1.234,5",3.1')], {}, "numbers with a decimal point"),
        (["Angle (deg);Deviation (um)", *(f"{a + 1.0:.0f},250;{100 + k},125" for k, (a, _) in enumerate(CIRCLE))], {},
         'may be a decimal mark or separate thousands (expected --decimal . or ,)'),
        (["Angle,Deviation (um)", *(f"{np.radians(a):.4f},{r:.2f}" for a, r in CIRCLE)], {},
         'column "Angle": no unit is stated; angles from 0 to 6.1959 as radians of a whole turn would (expected'),
        (["Angle (deg),Deviation", *ROWS], {},
         'column "Deviation": no unit is stated; values up to 10 (expected --unit reading=UNIT, one of um, mm'),
        (["Angle (deg),Deviation (mm)", *ROWS], {},
         "readings up to 10000 µm (expected ±1000 µm at most, the gauge's range); they look like µm: --unit"),
        (["Angle (deg),Length (mm),Radial (mm)", *(f"{a:g},1,{100.0 + r / 1e3:.5f}" for a, r in CIRCLE)], {},
         "values near 100 mm, the bar's own length (expected its deviation from it)"),
        (["Angle (deg),Deviation (um),Deviation 2 (um)", *(f"{row},1.0" for row in ROWS)], {},
         'reading: two columns, "Deviation (um)" and "Deviation 2 (um)" (columns 2 and 3) (expected one;'),
        ([HEAD, *(f"{a:.1f},{r:.1f}".replace(".", ",") for a, r in CIRCLE)], {},
         "line 2: 4 cells for 2 names (expected as many; a decimal comma needs another delimiter, or quotes;"),
        (["Angle, deg,Deviation (um)", *ROWS], {}, "line 2: 2 cells for 3 names (expected as many; columns may be"),
        (["A,B", *ROWS], {}, 'no column of angles among "A", "B" (expected --column angle=NAME)'),
        (ROWS, {}, "no column of angles among 2 without names"),
        (["Angle (deg),B", *ROWS], {}, "no column of readings among"),
        ([f"{HEAD},Direction", *(f"{row},up" for row in ROWS)], {}, 'line 2: column "Direction": "up" (expected 1 or'),
        ([f"{HEAD},Direction", *(f"{row},CW" for row in ROWS)], {},
         "line 2: angles rise in a clockwise run (expected --angle-counts travel where they count along every run"),
        ([f"{HEAD},Circle", *(f"{row},4" for row in ROWS)], {}, "line 2: circle: 4 (expected the id of a circle of"),
        ([HEAD, *(row for row in ROWS for _ in (0, 1))], {}, "angle 0, as in the line before (expected one that"),
        ([f"{HEAD},Time", *(f"{row},{k}" for k, row in enumerate(ROWS))], {}, 'column "Time": no unit is stated'),
        ([f"{HEAD},Time", *(f"{row},early" for row in ROWS)], {}, '"early" (expected a number, or a time as 2026'),
        ([f"{HEAD},s1 (mm),s2 (mm)", *(f"{row},1,2" for row in ROWS)], {}, "no column of s3, s4, s5, s6 (expected all"),
        ([HEAD, *changed(changed(ROWS, 66, "x,1"), 67, "x,1")], {},
         "line 70: looks like a row of the table, lines 2-67 (expected none; --rows 2:67 leaves it out)"),
        ([HEAD, *changed(ROWS, 3, '15,"1.0')], {}, "line 5: a stray quote (expected every quote closed"),
        ([HEAD, *ROWS], {"units": {"angle": "mm"}}, 'units.angle: "mm" (expected one of deg, rad'),
        ([HEAD, *ROWS], {"columns": {"reeding": 2}}, "columns.reeding: 2 (expected a quantity: reading)"),
    ],
)  # fmt: skip
def test_tables_are_refused_in_one_line(
    tmp_path: Path, lines: list[str], choices: dict[str, Any], message: str
) -> None:
    path = tmp_path / "readings.csv"
    path.write_text("\n".join(lines))
    assert message in refusal(path, **choices)


def test_a_number_turned_into_a_date_is_named(tmp_path: Path) -> None:
    from datetime import datetime

    from openpyxl import Workbook

    book = Workbook()
    book.active.append(["Angle (deg)", "Deviation (um)"])
    for place, (angle, reading) in enumerate(CIRCLE):
        book.active.append([angle, datetime(2026, 2, 1) if place == 20 else reading])
    book.save(tmp_path / "readings.xlsx")
    said = refusal(tmp_path / "readings.xlsx")
    assert "row 22: column 2: 2026-02-01T00:00:00 (a date) (expected a number; a spreadsheet program may have" in said


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 no zip", b"\xd0\xcf\x11\xe0 an old workbook"])
def test_what_is_no_workbook_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "a.xlsx").write_bytes(content)
    assert "not a workbook (expected an Excel workbook, .xlsx" in refusal(tmp_path / "a.xlsx")


def test_truncated_workbooks_are_refused(tmp_path: Path) -> None:
    whole = (FOLDER / "dates.xlsx").read_bytes()
    for part in (0.1, 0.5, 0.99):
        (tmp_path / "a.xlsx").write_bytes(whole[: int(part * len(whole))])
        assert "workbook" in refusal(tmp_path / "a.xlsx")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("</RUN_RESULTS>", "", "not XML: mismatched tag (expected a whole XML file; this one is cut off or damaged)"),
        ("<RUN_DIRECTION>CW<", "<RUN_DIRECTION>UP<", 'BALLBAR_RUN 2: RUN_DIRECTION: "UP" (expected CCW or CW)'),
        (">100</NOM", ">50</NOM", "NOMINAL_LENGTH: 50 (expected 100, gauge.bar_length_mm of thesis)"),
        (">753.98<", ">30<", "PROGRAMMED_FEEDRATE: 30 (expected a feed of thesis, 753.98 mm/min, or --feed: the unit"),
        (">753.98<", "><", 'PROGRAMMED_FEEDRATE: "" (expected a number)'),
        ("RUN_RESULTS", "RESULTS", "TEST_DOCUMENT: no RUN_RESULTS in it (expected a Renishaw test"),
        ("READINGS", "VALUES", "BALLBAR_RUN 1: no READINGS, 1 FEATUREs only (expected a test saved with its readings)"),
        ("-0.08060", "-0,08060", 'READINGS: number 2: "-0,08060" (expected a number with a decimal point)'),
        ("<TEST_DOCUMENT>", '<!DOCTYPE a [<!ENTITY b "c">]><TEST_DOCUMENT>', "declares EntitiesForbidden"),
    ],
)
def test_renishaw_tests_are_refused_in_one_line(tmp_path: Path, old: str, new: str, message: str) -> None:
    text = (FOLDER / "test.b5r").read_text()
    assert old in text
    (tmp_path / "test.b5r").write_text(text.replace(old, new))
    said = refusal(tmp_path / "test.b5r", units={"reading": "mm"}, start_angle_deg=0.0, arc_deg=360.0)
    assert message in said


def test_truncated_renishaw_tests_are_refused(tmp_path: Path) -> None:
    whole = (FOLDER / "test.b5r").read_bytes()
    for part in (0.0, 0.01, 0.3, 0.9, 0.999):
        (tmp_path / "test.b5r").write_bytes(whole[: int(part * len(whole))])
        assert "(expected a whole XML file; this one is cut off or damaged)" in refusal(tmp_path / "test.b5r")


def test_a_unit_that_is_stated_is_believed_whatever_it_gives(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n".join(["Angle (deg),Deviation (um)", *(f"{a:g},{r / 1e3}" for a, r in CIRCLE)]))
    record = imported(tmp_path / "a.csv", units={"reading": "um"})
    assert np.abs(record.columns["reading_um"]).max() <= 0.01


def test_a_machine_that_does_not_reach_the_circle_is_named(tmp_path: Path) -> None:
    from hexdbb.plan import load_plan, save_plan

    plan = load_plan("thesis")
    mount = plan.mounts[0].model_copy(update={"cup_mm": (300.0, 0.0, 340.0)})
    save_plan(plan.model_copy(update={"mounts": (mount,)}), tmp_path / "far.toml")
    said = refusal("german.csv", plan=str(tmp_path / "far.toml"))
    assert "german.csv: line " in said
    assert "does not reach circle 0 at" in said


def test_every_suffix_that_is_read_has_one_reader() -> None:
    assert set(foreign.READERS) == {".csv", ".txt", ".tsv", ".dat", ".asc", ".xlsx", ".xlsm", ".b5r", ".xml"}
    assert "suffix '.odt' (expected one of .parquet, .csv, .xlsx" in refusal("none.odt")
