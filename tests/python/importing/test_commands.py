"""Files of other programs at the command line: convert, mapping files, and every command that takes records."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import click
import numpy as np
import pytest
from click.testing import CliRunner, Result
from tests.python.importing.conftest import FOLDER

from hexdbb.cli import cli
from hexdbb.cli.import_options import OF_RECORDS, given_options, import_options
from hexdbb.errors import InputError
from hexdbb.importing import load_mapping, mapping_of, read_record
from hexdbb.importing.mapping import save_mapping
from hexdbb.record import read_record as read_own_record
from hexdbb.record import write_record


def hexdbb(*arguments: object) -> Result:
    return CliRunner().invoke(cli, [str(each) for each in arguments], standalone_mode=False)


def done(*arguments: object) -> Result:
    result = hexdbb(*arguments)
    assert result.exception is None, result.exception
    return result


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """A folder with some of the files."""
    for name in ("german.csv", "spaces.dat", "spaces.toml", "test.b5r", "mm_as_um.csv", "two_tables.csv"):
        shutil.copy(FOLDER / name, tmp_path)
    return tmp_path


def test_convert_says_in_one_line_what_it_detected(place: Path) -> None:
    result = done("convert", place / "german.csv", place / "a.parquet", "--plan", "thesis")
    assert result.stderr.count("\n") == 1
    assert "cp1252, delimiter semicolon, decimal comma" in result.stderr
    assert result.stdout == f"{place / 'a.parquet'}: 402 samples, 2 sweeps\n"
    again = done("convert", place / "a.parquet", place / "b.csv")
    assert again.stderr == ""


def test_a_mapping_is_saved_and_found_beside_the_file(place: Path) -> None:
    options = ("--plan", "thesis", "--unit", "reading=mm", "--column", "direction=Run direction")
    done("convert", place / "mm_as_um.csv", place / "a.parquet", *options, "--save-mapping", place / "mm_as_um.toml")
    again = done("convert", place / "mm_as_um.csv", place / "b.parquet")
    records = [read_own_record(place / name) for name in ("a.parquet", "b.parquet")]
    assert records[0].content_hash() == records[1].content_hash()
    shutil.move(place / "mm_as_um.toml", place / "habit.toml")
    done("convert", place / "mm_as_um.csv", place / "c.parquet", "--mapping", place / "habit.toml")
    assert "in mm" in again.stderr
    with pytest.raises(InputError, match="exists already"):
        raise hexdbb("convert", place / "mm_as_um.csv", place / "d.parquet", *options, "--save-mapping",
                     place / "habit.toml").exception or AssertionError  # fmt: skip
    assert not (place / "d.parquet").exists()


def test_paths_of_a_mapping_are_relative_to_its_file(place: Path) -> None:
    (place / "plans").mkdir()
    (place / "mappings").mkdir()
    shutil.copy(Path(__file__).parents[3] / "python/hexdbb/data/plans/thesis.toml", place / "plans" / "own.toml")
    save_mapping(mapping_of(plan=str(place / "plans" / "own.toml")), place / "mappings" / "m.toml")
    assert 'plan = "../plans/own.toml"' in (place / "mappings" / "m.toml").read_text()
    assert len(read_record(place / "german.csv", mapping=place / "mappings" / "m.toml")) == 402
    assert load_mapping(place / "mappings" / "m.toml").plan == str(place / "mappings" / "../plans/own.toml")


def test_options_replace_keys_of_the_mapping_file(place: Path) -> None:
    with pytest.raises(InputError, match=r'"thesis" has|which circle of standard'):
        read_record(place / "spaces.dat", plan="standard")
    assert len(read_record(place / "spaces.dat", circle=0)) == 402


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--unit", "reading"), '--unit "reading": no "=" (expected QUANTITY=VALUE, as reading=um)'),
        (("--unit", "reading=parsec"), 'options: units.reading: "parsec" (expected one of um, mm'),
        (("--column", "sliders=2"), "options: columns.sliders: 2 (expected a quantity: "),
        (("--rows", "9"), '--rows "9" (expected FIRST:LAST, lines as 5:364)'),
        (("--rows", "9:5"), "options: rows[0]: [9, 5] (expected the first line before the last"),
        (("--mapping", "none.toml"), "none.toml: no such file"),
        (("--delimiter", ";"), "options: delimiter: \";\" (expected 'comma', 'semicolon', 'tab', 'bar' or 'space')"),
        (("--feed", "-3"), "options: feed_mm_min: -3 (expected a number > 0)"),
    ],
)
def test_wrong_options_are_refused_in_one_line(place: Path, options: tuple[str, ...], message: str) -> None:
    result = hexdbb("convert", place / "german.csv", place / "a.parquet", "--plan", "thesis", *options)
    assert isinstance(result.exception, InputError)
    assert message in str(result.exception)
    assert not (place / "a.parquet").exists()


def test_a_following_command_is_told_the_same_of_the_files() -> None:
    @click.command()
    @import_options(OF_RECORDS)
    def command() -> None:
        click.echo(" ".join(given_options()))

    told = CliRunner().invoke(command, ["--circle", "3", "--plan", "thesis"])
    assert told.output == "--plan thesis --circle 3\n"
    assert CliRunner().invoke(command, []).output == "\n"


def test_records_go_through_excel_and_the_text_form(place: Path) -> None:
    done("convert", place / "german.csv", place / "a.parquet", "--plan", "thesis")
    done("convert", place / "a.parquet", place / "b.xlsx")
    done("convert", place / "b.xlsx", place / "c.csv")
    done("convert", place / "c.csv", place / "d.parquet")
    first, *others = (read_record(place / name) for name in ("a.parquet", "b.xlsx", "c.csv", "d.parquet"))
    for other in others:
        for name, values in first.columns.items():
            np.testing.assert_allclose(other.columns[name], values, rtol=5e-16)  # half a unit of 16 digits
        assert (other.gauge, other.mounts, other.circles) == (first.gauge, first.mounts, first.circles)
        assert other.machine == first.machine
        assert other.not_measured == first.not_measured
        assert other.metadata["plan"] == "thesis"


def test_a_frame_holds_all_of_a_record() -> None:
    pytest.importorskip("pandas")
    record = read_record(FOLDER / "plain.csv", plan="thesis")
    frame = record.to_frame()
    np.testing.assert_array_equal(frame["reading_um"], record.columns["reading_um"])
    assert frame.attrs["measurement"]["gauge"]["bar_length_mm"] == 100.0
    assert frame.attrs["machine"]["legs"]["length_mm"] == record.machine.legs.length_mm
    assert frame.attrs["metadata"]["not_measured"]["sliders"].startswith("nominal inverse kinematics")
    frame.copy().to_csv(None)  # attrs are plain values: pandas copies and compares them


def test_excel_workbooks_that_are_damaged_are_refused(place: Path) -> None:
    record = read_record(FOLDER / "plain.csv", plan="thesis")
    write_record(record, place / "a.xlsx")
    from openpyxl import load_workbook

    book = load_workbook(place / "a.xlsx")
    column = list(record.columns).index("reading_um") + 1
    book["samples"].cell(row=10, column=column).value = 9000.0
    book.save(place / "b.xlsx")
    with pytest.raises(InputError, match=r"b\.xlsx: sheet samples: row 9 \(line 10\): reading_um: 9000 \(expected"):
        read_record(place / "b.xlsx")


def test_compare_without_a_model_gives_iso_quantities_and_harmonics(place: Path) -> None:
    options = ("--plan", "thesis", "--json", "--plot", place / "seen")
    result = done("compare", place / "german.csv", *options)
    found = json.loads(result.stdout)
    assert found["predicted_by"] == "commanded circle"
    assert (place / "seen.png").stat().st_size > 10_000
    with_model = done("model", "new", "sp120", "-o", place / "nominal.toml", "--effects", "none")
    assert with_model.exit_code == 0
    same = json.loads(
        done("compare", place / "german.csv", "--plan", "thesis", "-m", place / "nominal.toml", "--json", "--no-plot",
             "--no-cause").stdout
    )  # fmt: skip
    for own, other in zip(found["circles"], same["circles"], strict=True):
        for key in ("circular_deviation_um", "bidirectional_circular_deviation_um", "radial_deviation_max_um"):
            assert own[key] == other[key]
    # The cup's offset, 110 µm, is no error: both directions together have no harmonic of order 1.
    first = [part["harmonics"][0] for part in found["circles"]]
    both = sum(each["amplitude_um"] * np.exp(1j * np.radians(each["phase_deg"])) for each in first) / 2.0
    assert abs(both) < 0.2
    assert found["radial"] == same["radial"]
    text = done("compare", place / "german.csv", "--plan", "thesis", "--no-plot").stdout
    assert "No model: predicted is the commanded circle about the cup" in text


def test_effects_of_ones_own_need_a_model_to_be_compared(place: Path) -> None:
    result = hexdbb("compare", place / "german.csv", "--plan", "thesis", "--effects", place / "none.py", "--no-plot")
    assert isinstance(result.exception, InputError)


def test_a_workbench_session_reads_them_and_writes_them_into_its_script(place: Path) -> None:
    from hexdbb.workbench import Session

    said: list[str] = []
    session = Session([place / "german.csv"], mapping=mapping_of(plan="thesis"), tell=said.append)
    assert len(session.samples) == 402
    assert len(said) == 1
    assert "german.csv', plan='thesis')" in str(session.script)


def test_what_only_convert_can_be_told_is_named_with_where_it_is_kept(place: Path) -> None:
    asked = hexdbb("compare", place / "test.b5r", "--plan", "thesis", "--no-plot")
    hint = (
        f"; --unit is an option of hexdbb convert, whose --save-mapping {place / 'test.toml'} keeps it for this command"
    )
    assert str(asked.exception).endswith(hint)
    assert "is an option of" not in str(hexdbb("compare", place / "german.csv", "--no-plot").exception)
    assert "is an option of" not in str(
        hexdbb("convert", place / "test.b5r", place / "a.parquet", "--plan", "thesis").exception
    )
    done(
        "convert",
        place / "two_tables.csv",
        place / "a.parquet",
        "--plan",
        "thesis",
        "--rows",
        "3:203",
        "--save-mapping",
        place / "two_tables.toml",
    )
    done("compare", place / "two_tables.csv", "--no-plot")
