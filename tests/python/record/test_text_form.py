"""The text form as other programs write it, good and bad."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from hexdbb.errors import InputError
from hexdbb.machine import shipped
from hexdbb.record import read_record, write_record
from hexdbb.record.laps import counted_laps

MEASUREMENT = """schema = "hexdbb.measurement/1"
machine = "machine.toml"
[gauge]
bar_length_mm = 100.0
resolution_um = 0.1
range_um = 1000.0
[[mount]]
id = 0
cup_mm = [0.0, 0.0, 340.0]
[[circle]]
id = 0
mount = 0
radius_mm = 100.0
ball_offset_mm = [0.0, 0.0, 60.0]
plane_rpy_deg = [0.0, 0.0, 0.0]
platform_rpy_deg = [0.0, 0.0, 0.0]
"""
HEADER = "reading_um,t_s,circle,sweep,direction,lap,angle_deg,feed_mm_min,s1_mm,s2_mm,s3_mm,s4_mm,s5_mm,s6_mm,spindle"
ROWS = [f"-1.5,{0.5 * row},0,{row // 2},1,0,{90 * row},754,300,600,300,600,300,600,on" for row in range(4)]


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """A folder with machine and measurement file, and a good CSV."""
    shutil.copy(shipped("sp120.toml"), tmp_path / "machine.toml")
    (tmp_path / "a.toml").write_text(MEASUREMENT)
    write(tmp_path, [HEADER, *ROWS])
    return tmp_path


def write(place: Path, lines: list[str], end: str = "\n") -> None:
    (place / "a.csv").write_bytes((end.join(lines) + end).encode())


def error_of(place: Path) -> str:
    with pytest.raises(InputError) as caught:
        read_record(place / "a.csv")
    assert "\n" not in str(caught.value)
    return str(caught.value).removeprefix(f"{place}/")


def test_columns_in_any_order_and_extra_ones_are_kept(place: Path) -> None:
    record = read_record(place / "a.csv")
    assert record.columns["t_s"].tolist() == [0.0, 0.5, 1.0, 1.5]
    assert record.columns["spindle"].tolist() == ["on"] * 4
    assert [len(rows) for rows in record.sweeps()] == [2, 2]
    assert record.gauge.noise_um is None
    write_record(record, place / "b.csv")
    assert read_record(place / "b.csv").columns["spindle"].tolist() == ["on"] * 4


@pytest.mark.parametrize(
    "rewrite",
    [
        pytest.param(lambda line: line.replace(",", ", "), id="blanks after commas"),
        pytest.param(lambda line: line.replace(",on", ',"on"').replace("t_s", '"t_s"'), id="quotes"),
        pytest.param(lambda line: line.replace(",0,754", ",0.0,754.0").replace(",1,0,", ",+1,0.0,"), id="floats"),
        pytest.param(lambda line: line.replace("90", "-720.5"), id="angle beyond a turn"),
    ],
)
def test_what_other_programs_write_is_accepted(place: Path, rewrite: Callable[[str], str]) -> None:
    expected = read_record(place / "a.csv")
    write(place, [rewrite(line) for line in (HEADER, *ROWS)])
    again = read_record(place / "a.csv")
    for name in ("t_s", "direction", "lap", "s6_mm", "reading_um"):
        np.testing.assert_array_equal(again.columns[name], expected.columns[name])


def test_line_ends_byte_order_mark_and_empty_lines_are_accepted(place: Path) -> None:
    expected = read_record(place / "a.csv").content_hash()
    write(place, ["\ufeff" + HEADER, ROWS[0], "", *ROWS[1:], ""], end="\r\n")
    assert read_record(place / "a.csv").content_hash() == expected


def test_temperature_is_optional_and_may_have_gaps(place: Path) -> None:
    lines = [
        f"{line},{cell}" for line, cell in zip((HEADER, *ROWS), ("temperature_c", "20.5", "", "20", "21"), strict=True)
    ]
    write(place, lines)
    np.testing.assert_array_equal(read_record(place / "a.csv").columns["temperature_c"], [20.5, np.nan, 20.0, 21.0])


def test_shipped_machine_may_be_named(place: Path) -> None:
    expected = read_record(place / "a.csv")
    (place / "a.toml").write_text(MEASUREMENT.replace('"machine.toml"', '"sp120"'))
    assert read_record(place / "a.csv").machine == expected.machine


BAD_CELLS = [
    ("-1.5,0.5", "abc,0.5", 'a.csv: row 2 (line 3): reading_um: "abc" (expected a number)'),
    ("-1.5,0.5", ",0.5", "a.csv: row 2 (line 3): reading_um: "),
    ("-1.5,0.5", "nan,0.5", "a.csv: row 2 (line 3): reading_um: nan (expected a finite number)"),
    ("-1.5,0.5", "NaN,0.5", "a.csv: row 2 (line 3): reading_um: "),
    (
        "-1.5,1.0",
        "1000.1,1.0",
        "a.csv: row 3 (line 4): reading_um: 1000.1 (expected a reading within the gauge's range",
    ),
    ("-1.5,0.5,0", "-1.5,0.5,9", "a.csv: row 2 (line 3): circle: 9 (expected the id of a circle: 0)"),
    ("-1.5,0.5,0,0,1", "-1.5,0.5,0,0,2", "a.csv: row 2 (line 3): direction: 2 (expected 1 (counter-clockwise) or"),
    ("-1.5,0.5,0,0,1,0", "-1.5,0.5,0,0,1,0.5", "a.csv: row 2 (line 3): lap: 0.5 (expected a whole number"),
    ("-1.5,1.5", "-1.5,1.0", "a.csv: row 4 (line 5): t_s: 1 (expected a time after 1.0, the row before)"),
    ("-1.5,1.5", "-1.5", "a.csv: row 4 (line 5): cells: 14 (expected 15, as the first line has)"),
    ("-1.5,1.5", "-1.5,1.5,,", "a.csv: row 4 (line 5): cells: 17 (expected 15"),
    (
        "-1.5,1.5",
        "-1,5,1.5",
        "a.csv: row 4 (line 5): cells: 16 (expected 15, as the first line has; the decimal mark is a point)",
    ),
    ("-1.5,1.5", '"-1.5,1.5', "a.csv: line 5: a stray quote (expected every quote closed in its line"),
    ("-1.5,1.5", '-1.5","1.5', "a.csv: line 5: a stray quote"),
    ("reading_um", '"reading_um', "a.csv: line 1: a stray quote"),
    ("-1.5,1.5", "-1.5,1;5", 'a.csv: row 4 (line 5): t_s: "1;5" (expected a number)'),
    (",600,on", ",6000,on", "a.csv: row 1 (line 2): s6_mm: 6000 (expected within the travel"),
    ("0.5,0,0", "0.5,1e99,0", "a.csv: row 2 (line 3): circle: 1e+99 (expected a whole number from"),
    ("s4_mm", "s4_um", "a.csv: column s4_um (expected s4_mm: the unit is part of the name)"),
    ("s4_mm", "fourth", "a.csv: missing column s4_mm (columns present: reading_um, t_s"),
    ("lap", "t_s", "a.csv: column t_s: occurs twice"),
    (",", ";", "a.csv: line 1: one column 'reading_um;t_s;"),
]


def test_a_stray_quote_in_a_long_file_is_named_by_its_line(place: Path) -> None:
    """The standard library gives up after 131,072 characters of one cell, with an exception of its own."""
    rows = [f"-1.5,{row},0,0,1,0,0.0,754,100,200,300,400,500,600,on" for row in range(5000)]
    rows[70] = '"' + rows[70]
    write(place, [HEADER, *rows])
    assert error_of(place).startswith("a.csv: line 72: a stray quote")


def test_two_stray_quotes_do_not_swallow_the_rows_between_them(place: Path) -> None:
    """In a column of text the rows would become one cell, and no number would be wrong."""
    rows = [ROWS[0].removesuffix("on") + '"on', ROWS[1] + '"', *ROWS[2:]]
    write(place, [HEADER, *rows])
    assert error_of(place).startswith("a.csv: line 2: a stray quote")


def test_names_with_commas_and_quotes_are_written_so_that_they_are_read_again(place: Path) -> None:
    record = read_record(place / "a.csv")
    record.columns['load, "N"'] = np.arange(4.0)
    write_record(record, place / "b.csv")
    assert read_record(place / "b.csv").columns['load, "N"'].tolist() == [0.0, 1.0, 2.0, 3.0]


@pytest.mark.parametrize(("old", "new", "message"), BAD_CELLS)
def test_bad_cell_is_named_by_row_line_column_and_value(place: Path, old: str, new: str, message: str) -> None:
    lines = [line.replace(old, new) for line in (HEADER, *ROWS)]
    assert lines != [HEADER, *ROWS]
    write(place, lines)
    assert error_of(place).startswith(message)


def test_line_is_counted_in_the_file_even_after_empty_lines(place: Path) -> None:
    write(place, [HEADER, "", ROWS[0], "", ROWS[1].replace("-1.5,", "x,"), *ROWS[2:]])
    assert error_of(place).startswith('a.csv: row 2 (line 5): reading_um: "x"')


def test_empty_files_are_refused(place: Path) -> None:
    (place / "a.csv").write_bytes(b"")
    assert error_of(place).startswith("a.csv: empty file (expected a first line of column names: t_s, circle")
    write(place, [HEADER])
    assert error_of(place) == "a.csv: holds no samples (expected at least one)"


def test_file_of_another_encoding_is_refused(place: Path) -> None:
    (place / "a.csv").write_bytes("führung\n".encode("latin-1"))
    assert error_of(place).startswith("a.csv: byte 1 is not UTF-8")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("[[circle]]\nid = 0", "[[circle]]\nid = 0\nmass = 3", "a.toml: circle[0].mass: unknown key"),
        ("radius_mm", "radius_um", "a.toml: circle[0].radius_um: unknown key (expected radius_mm"),
        ("mount = 0", "mount = 1", "a.toml: circle[0].mount: 1 (expected the id of a mount: 0)"),
        (
            "[[circle]]\nid = 0",
            "[[circle]]\nid = 5",
            "a.csv: row 1 (line 2): circle: 0 (expected the id of a circle: 5)",
        ),
        ('"machine.toml"', '"no.toml"', 'a.toml: machine: "no.toml": no such file'),
        ("measurement/1", "plan/1", 'a.toml: schema: "hexdbb.plan/1" (expected "hexdbb.measurement/1")'),
    ],
)
def test_bad_measurement_file_is_named_by_key_and_value(place: Path, old: str, new: str, message: str) -> None:
    (place / "a.toml").write_text(MEASUREMENT.replace(old, new))
    assert error_of(place).startswith(message)


def test_circle_of_two_ids_is_refused(place: Path) -> None:
    (place / "a.toml").write_text(MEASUREMENT + MEASUREMENT[MEASUREMENT.index("[[circle]]") :])
    assert error_of(place).startswith("a.toml: circle[1].id: 0 (expected an id of its own: circle[0] has this one)")


def test_missing_measurement_file_is_named(place: Path) -> None:
    (place / "a.toml").unlink()
    assert error_of(place).startswith(f"a.csv: no such file {place}/a.toml")


@pytest.mark.parametrize("begin_deg", [0.0, 90.0])
def test_laps_are_counted_from_the_angle_where_they_are_left_out(tmp_path: Path, begin_deg: float) -> None:
    turned = np.concatenate([np.arange(0.0, 720.0, 3.7), np.arange(0.0, 1080.0, 7.0)])
    sweep = np.repeat([0, 1], [195, 155])
    direction = np.where(sweep == 0, 1.0, -1.0)
    columns = {"sweep": sweep, "direction": direction, "angle_deg": (begin_deg + direction * turned) % 360.0}
    laps = counted_laps(columns)
    assert laps is not None
    assert np.array_equal(laps, np.floor(turned / 360.0))
    assert counted_laps({"sweep": sweep}) is None


def test_the_reading_that_closes_a_turn_is_no_lap_of_its_own() -> None:
    angle_deg = np.arange(0.0, 721.0, 4.0) % 360.0
    laps = counted_laps({"sweep": np.zeros(181), "direction": np.ones(181), "angle_deg": angle_deg})
    assert laps is not None
    assert np.array_equal(laps, np.repeat([0.0, 1.0], [90, 91]))


def test_a_record_without_laps_is_that_with_them(place: Path) -> None:
    whole = read_record(place / "a.csv")
    rows = [line.split(",") for line in (HEADER, *ROWS)]
    lap = rows[0].index("lap")
    write(place, [",".join(cells[:lap] + cells[lap + 1 :]) for cells in rows])
    assert np.array_equal(read_record(place / "a.csv").columns["lap"], whole.columns["lap"])
    write(place, [",".join(cells[1:lap] + cells[lap + 1 :]) for cells in rows])
    assert error_of(place).startswith("a.csv: missing column reading_um (")
