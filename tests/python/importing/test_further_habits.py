"""Further habits: other languages, comment marks, units in a row of their own, tables side by side, sheets of text."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from openpyxl import Workbook
from tests.python.importing.conftest import imported, refusal

ANGLES = np.concatenate([np.arange(0.0, 360.0, 5.0), np.arange(360.0, 0.0, -5.0)])
READINGS = np.round(10.0 * np.sin(np.radians(3.0 * ANGLES)) + np.repeat([0.5, -0.5], 72), 1)
SIGNS = np.repeat([1, -1], 72)


def table(
    heads: Sequence[str], words: tuple[str, str] = ("CCW", "CW"), delimiter: str = ";", scale: float = 1.0
) -> list[str]:
    """Return headings, then a row for each reading: angle, reading, word of its direction."""
    rows = (
        delimiter.join([f"{angle:.1f}", f"{reading * scale:.8g}", words[0] if sign > 0 else words[1]])
        for angle, reading, sign in zip(ANGLES, READINGS, SIGNS, strict=True)
    )
    return [*heads, *rows]


@pytest.mark.parametrize(
    ("lines", "encoding"),
    [
        (table(["Winkel [°];Abweichung [µm];Drehsinn"], ("+", "\u2212")), "utf-16-le"),
        (table(["Angle polaire (°);Déviation (microns);Sens"], ("trigonométrique", "horaire")), "utf-16-be"),
        (table(["Ángulo [grados];Desviación [µm];Sentido"], ("antihorario", "horario")), "utf-8"),
        (table(["Angolo [gradi];Scostamento [μm];Senso"], ("antiorario", "orario")), "utf-8"),
        (table(["角度（度）;偏差（㎛）;回転方向"], ("反時計回り", "時計回り")), "utf-8-sig"),
        (table(["角度[°];误差[微米];方向"], ("逆时针", "顺时针")), "utf-8"),
        (table(["Angle (deg);Error (µin);Dir"], ("ACW", "CW"), scale=1.0 / 0.0254), "utf-8"),
        (table(["# a run of Monday", "# angle_deg deviation_um direction"], ("1", "-1"), " "), "utf-8"),
        (table(["%angle_deg\tdeviation_um\tdirection"], ("1", "-1"), "\t"), "utf-8"),
        (table(["Position;Error;Direction", "commanded;radial;", "deg;um;"]), "utf-8"),
        (table(["deg;um;", "Angle;Deviation;Direction"]), "utf-8"),
    ],
)
def test_tables_of_further_habits_give_their_values(tmp_path: Path, lines: list[str], encoding: str) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes("\r\n".join(lines).encode(encoding))
    columns = imported(path).columns
    np.testing.assert_allclose(columns["angle_deg"], ANGLES, atol=1e-9)
    np.testing.assert_allclose(columns["reading_um"], READINGS, atol=1e-6)
    assert (columns["direction"] == SIGNS).all()


def test_dates_with_points_are_times(tmp_path: Path) -> None:
    rows = table(["Winkel [°];Abweichung [µm];Richtung;Datum"])
    stamped = [f"{row};1.3.2026 23:59:{k // 4:02d},{25 * (k % 4):02d}" for k, row in enumerate(rows[1:])]
    (tmp_path / "a.csv").write_text("\n".join([rows[0], *stamped]))
    record = imported(tmp_path / "a.csv", decimal=".")
    np.testing.assert_allclose(np.diff(record.columns["t_s"]), 0.25, atol=1e-9)
    assert record.not_measured.time is None
    assert record.metadata["started"] == "2026-03-01T23:59:00"


@pytest.mark.parametrize(("clock", "is_timed"), [(";Time", True), ("", False)])
def test_a_column_of_days_is_the_day_of_the_test_and_no_time(tmp_path: Path, clock: str, is_timed: bool) -> None:
    head, *rows = table(["Angle (deg);Deviation (um);Direction"])
    times = [f";08:{k // 60:02d}:{k % 60:02d}" if is_timed else "" for k in range(len(rows))]
    lines = [f"Date{clock};{head}", *(f"2026-03-02{t};{row}" for t, row in zip(times, rows, strict=True))]
    (tmp_path / "a.csv").write_text("\n".join(lines))
    record = imported(tmp_path / "a.csv")
    assert record.metadata["started"] == "2026-03-02"
    assert (record.not_measured.time is None) == is_timed


def test_dates_that_may_be_read_in_two_ways_are_asked_about(tmp_path: Path) -> None:
    rows = table(["Angle (deg);Deviation (um);Direction;Date"])
    (tmp_path / "a.csv").write_text("\n".join([rows[0], *(f"{row};03/02/2026 10:00" for row in rows[1:])]))
    assert '"03/02/2026 10:00" (expected a number, or a time as 2026-03-01 10:22:03.250; --column time=' in refusal(
        tmp_path / "a.csv"
    )
    assert len(imported(tmp_path / "a.csv", columns={"time": ""})) == len(ANGLES)


UP, DOWN = (list(zip(ANGLES[half], READINGS[half], strict=True)) for half in (SIGNS > 0, SIGNS < 0))
BESIDE = [f"{a:g},{r:g},,{b:g},{q:g}" for (a, r), (b, q) in zip(UP, DOWN, strict=True)]


@pytest.mark.parametrize(
    ("heads", "choices"),
    [
        (["Angle (deg),Deviation (um),,Angle (deg),Deviation (um)"], {"angle": 4, "reading": 5}),
        (
            ["CCW,,,CW,", "Angle (deg),Deviation (um),,Angle (deg),Deviation (um)"],
            {"angle": 4, "reading": 5, "reading_ccw": "", "reading_cw": ""},
        ),
    ],
)
def test_of_two_tables_side_by_side_either_is_read_never_both_by_one_angle(
    tmp_path: Path, heads: list[str], choices: dict[str, int | str]
) -> None:
    path = tmp_path / "a.csv"
    path.write_text("\n".join([*heads, *BESIDE]))
    asked = " ".join(f"--column {name}={column}" for name, column in choices.items())
    for given in ({}, {"angle": 1}) if "CCW" in heads[0] else ({},):
        said = refusal(path, columns=given)
        assert "tables side by side: angles in columns 1 and 4 (expected one table; --column angle=1" in said
        assert f"{asked} reads one" in said
    columns = imported(path, columns=choices).columns
    np.testing.assert_allclose(columns["angle_deg"], ANGLES[72:])
    np.testing.assert_allclose(columns["reading_um"], READINGS[72:])
    assert (columns["direction"] == -1).all()


def test_the_sheet_with_a_table_is_found_though_its_numbers_are_texts(tmp_path: Path) -> None:
    book = Workbook()
    book.active.append(["Radius", 100])
    book.active.append(["min", -10.0, "max", 10.0])
    book.active.append(["min", -9.0, "max", 9.0])
    sheet = book.create_sheet("Monday")
    for row in table(["Winkel [°];Abweichung [µm];Richtung"]):
        sheet.append(row.replace(".", ",").split(";"))
    book.save(tmp_path / "a.xlsx")
    said: list[str] = []
    record = imported(tmp_path / "a.xlsx", said)
    np.testing.assert_allclose(record.columns["reading_um"], READINGS)
    assert "Excel, sheet Monday" in said[0]


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("a.xls", "(expected the sheet saved as .xlsx or .csv; one of .parquet"),
        ("a.ods", "(expected the sheet saved as .xlsx or .csv; one of .parquet"),
        ("a.csv.gz", "(expected the file unpacked; one of .parquet"),
    ],
)
def test_what_to_do_first_with_a_file_is_said(tmp_path: Path, name: str, message: str) -> None:
    (tmp_path / name).write_bytes(b"\x1f\x8b")
    assert message in refusal(tmp_path / name)


def test_units_in_cells_are_named(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n".join(["Angle;Deviation", *(f"{a:g}°;{r:g} µm" for a, r in UP)]))
    assert 'units belong into the headings, not into cells as "0°")' in refusal(tmp_path / "a.csv")


def test_empty_lines_between_all_lines_part_nothing(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n\n".join(table(["Winkel/°;Abw./µm;Richtung"])))
    np.testing.assert_allclose(imported(tmp_path / "a.csv").columns["reading_um"], READINGS)


ROWS = table(["Angle (deg);Deviation (um);Direction"])


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (
            [f"{ROWS[0]};Feed (mm/min)", *(f"{row};12.57" for row in ROWS[1:])],
            "12.57 mm/min (expected a feed of the plan, 753.98 mm/min; they look like mm/s: --unit feed=mm/s;",
        ),
        ([ROWS[0], *sorted(ROWS[1:])], "runs, with 1 reading (expected 8 or more in a run: rows in order of travel"),
        (
            [ROWS[0], *(f"{a / 360.0:.5f};{r};1" for a, r in UP)],
            'column "Angle (deg)", in deg by its name: angles span 0.9861° in steps of 0.0139° (expected 10° or more',
        ),
        (
            ["Angle;Deviation (um)", *(f"{1000.0 * a:g};{r}" for a, r in UP)],
            'column "Angle", no unit is stated: angles span 3.55e+05° in steps of 5e+03° (expected 10° or more',
        ),
    ],
)
def test_values_that_are_none_of_a_circle_are_refused(tmp_path: Path, lines: list[str], message: str) -> None:
    (tmp_path / "a.csv").write_text("\n".join(lines))
    assert message in refusal(tmp_path / "a.csv")


def test_a_feed_whose_unit_is_stated_is_believed(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n".join([f"{ROWS[0]};Feed (mm/min)", *(f"{row};12.57" for row in ROWS[1:])]))
    for unit, feed in (("mm/s", 754.2), ("mm/min", 12.57)):
        columns = imported(tmp_path / "a.csv", units={"feed": unit}).columns
        np.testing.assert_allclose(columns["feed_mm_min"], feed)
