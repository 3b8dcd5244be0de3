from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from hexdbb.errors import InputError, RunError
from hexdbb.machine import MachineFile, shipped_machine
from hexdbb.record import REQUIRED_COLUMNS, Record, read_record, write_record
from hexdbb.record.summary import SWEEPS_SHOWN_MAX

DiskFullAfter = Callable[[int], AbstractContextManager[None]]
FORMS = [".parquet", ".csv"]


def error_of(action: Callable[[], object]) -> str:
    with pytest.raises(InputError) as caught:
        action()
    assert "\n" not in str(caught.value)
    return str(caught.value)


def same_bits(one: Record, other: Record) -> bool:
    """Whether columns, types, bits and all else a record holds are the same; the sign of zero counts."""
    assert list(one.columns) == list(other.columns)
    columns = all(
        values.dtype == other.columns[name].dtype and values.tobytes() == other.columns[name].tobytes()
        for name, values in one.columns.items()
    )
    keys = ("gauge", "mounts", "circles", "machine", "complete")
    return columns and all(getattr(one, key) == getattr(other, key) for key in keys)


def written(record: Record, path: Path) -> Path:
    write_record(record, path)
    return path


@pytest.mark.parametrize("suffix", FORMS)
def test_written_and_read_again(record: Record, tmp_path: Path, suffix: str) -> None:
    again = read_record(written(record, tmp_path / f"a{suffix}"))
    assert same_bits(record, again)
    assert again.path == tmp_path / f"a{suffix}"
    assert again.content_hash() == record.content_hash()


any_float = st.floats(allow_nan=False, allow_infinity=False)
rows = st.integers(1, 8)


@settings(deadline=None, max_examples=50, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data(), count=rows)
def test_floats_survive_every_form_to_the_last_bit(
    record: Record, tmp_path_factory: pytest.TempPathFactory, data: st.DataObject, count: int
) -> None:
    within = {"angle_deg": any_float, "temperature_c": any_float, "target1_mm": any_float}
    within |= {f"s{k}_mm": st.floats(*record.machine.sliders.travel_mm) for k in range(1, 7)} | {
        "reading_um": st.floats(-1000.0, 1000.0)
    }
    columns: dict[str, Any] = {name: values[:count] for name, values in record.columns.items()}
    for name, values in within.items():
        columns[name] = data.draw(hnp.arrays(np.float64, count, elements=values))
    columns["t_s"] = np.cumsum(data.draw(hnp.arrays(np.float64, count, elements=st.floats(1e-9, 1e3))))
    original = replace(record, columns=columns)
    folder = tmp_path_factory.mktemp("forms")
    write_record(original, folder / "a.csv")
    write_record(read_record(folder / "a.csv"), folder / "b.parquet")
    again = read_record(folder / "b.parquet")
    assert same_bits(original, again)
    assert again.content_hash() == original.content_hash()


def test_pandas_reads_the_parquet_file_as_it_is(record: Record, tmp_path: Path) -> None:
    frame = pandas.read_parquet(written(record, tmp_path / "a.parquet"))
    assert {name: frame[name].dtype for name in REQUIRED_COLUMNS} == REQUIRED_COLUMNS
    np.testing.assert_array_equal(frame["reading_um"], record.columns["reading_um"])


def test_parquet_file_stands_alone(record: Record, tmp_path: Path) -> None:
    path = written(record, tmp_path / "a.parquet")
    metadata = pq.read_schema(path).metadata
    assert b"bar_length_mm = 100.0" in metadata[b"hexdbb.measurement"]
    assert b"inradius_mm = 250.0" in metadata[b"hexdbb.machine"]
    again = read_record(path)
    assert again.metadata["can"] == {"bus": "none"}
    assert again.metadata["software"].startswith("hexdbb ")


@pytest.mark.parametrize("suffix", FORMS)
def test_incomplete_stays_incomplete(record: Record, tmp_path: Path, suffix: str) -> None:
    assert not read_record(written(replace(record, complete=False), tmp_path / f"a{suffix}")).complete


@pytest.mark.parametrize("suffix", FORMS)
def test_existing_file_is_not_overwritten_unasked(record: Record, tmp_path: Path, suffix: str) -> None:
    path = written(record, tmp_path / f"a{suffix}")
    before = {file: file.read_bytes() for file in tmp_path.iterdir()}
    other = replace(record, columns={**record.columns, "lap": record.columns["lap"] + 1})
    assert "exists already" in error_of(lambda: write_record(other, path))
    assert {file: file.read_bytes() for file in tmp_path.iterdir()} == before
    write_record(other, path, overwrite=True)
    assert same_bits(read_record(path), other)
    assert len(list(tmp_path.iterdir())) == len(before), "no temporary file is left behind"


def test_text_form_is_written_whole_or_not_at_all(record: Record, tmp_path: Path) -> None:
    (tmp_path / "a.toml").write_text("mine")
    assert "a.toml: exists already" in error_of(lambda: write_record(record, tmp_path / "a.csv"))
    assert [file.name for file in tmp_path.iterdir()] == ["a.toml"]


def test_failed_write_leaves_what_was_there(record: Record, tmp_path: Path, disk_full_after: DiskFullAfter) -> None:
    path = written(record, tmp_path / "a.parquet")
    before = path.read_bytes()
    with disk_full_after(3000), pytest.raises(RunError, match=r"a\.parquet: cannot be written: .*File too large"):
        write_record(record, path, overwrite=True)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_a_record_shows_its_sweeps(record: Record) -> None:
    record.columns["reading_um"][:] = np.linspace(-12.34, 45.67, len(record))
    assert repr(record) == (
        "<Record record: 50 samples, 2 sweeps, 1 circle, feed 753.98 mm/min, readings -12.3 to 45.7 µm, complete>"
    )
    shown = record._repr_html_()
    assert shown.count("<tr>") == 1 + 1 + 2, "caption, heads and a row per sweep"
    assert "<td>1</td><td>0</td><td>0</td><td>+1</td><td>753.98</td><td>1</td><td>25</td><td>0.100</td>" in shown
    part = record.part(np.zeros(len(record), dtype=bool))
    assert repr(part) == "<Record record: no samples>"
    assert "no samples" in part._repr_html_()


def test_a_record_of_many_sweeps_is_shown_in_part(record: Record) -> None:
    many = replace(record, columns={**record.columns, "sweep": np.arange(50) % 25}, complete=False)
    assert "25 sweeps" in repr(many) and "incomplete" in repr(many)
    tiled = {name: np.tile(values, 3) for name, values in record.columns.items()}
    shown = replace(record, columns={**tiled, "sweep": np.arange(150)})._repr_html_()
    assert f"<td>{150 - SWEEPS_SHOWN_MAX} more</td>" in shown


def test_a_record_is_a_frame(record: Record) -> None:
    frame = record.to_frame()
    assert list(frame.columns) == list(record.columns)
    assert frame.dtypes.to_dict() == {name: values.dtype for name, values in record.columns.items()}
    np.testing.assert_array_equal(frame["s4_mm"], record.sliders_mm[:, 3])


def test_sweeps_come_in_the_order_they_were_captured(record: Record) -> None:
    swapped = replace(record, columns={**record.columns, "sweep": 7 - 5 * record.columns["sweep"]})
    assert [swapped.columns["sweep"][rows][0] for rows in swapped.sweeps()] == [7, 2]
    assert [rows.tolist() for rows in swapped.sweeps()] == [list(range(25)), list(range(25, 50))]


def test_arrays_are_in_mm_and_in_slider_order(record: Record) -> None:
    assert record.sliders_mm.shape == (50, 6)
    np.testing.assert_array_equal(record.sliders_mm[:, 3], record.columns["s4_mm"])
    np.testing.assert_allclose(record.reading_mm * 1000.0, record.columns["reading_um"], rtol=1e-15)


def test_content_hash_tells_records_apart(record: Record) -> None:
    reading = record.columns["reading_um"].copy()
    reading[7] = np.nextafter(reading[7], np.inf)
    changed = [
        replace(record, columns={**record.columns, "reading_um": reading}),
        replace(record, mounts=(record.mounts[0].model_copy(update={"cup_mm": (0.0, 0.0, 341.0)}),)),
        replace(record, machine=other_machine()),
    ]
    hashes = {record.content_hash(), *(each.content_hash() for each in changed)}
    assert len(hashes) == 4
    extra = replace(record, columns={**record.columns, "note": np.zeros(len(record))})
    assert extra.content_hash() == record.content_hash(), "columns beyond the required ones do not count"


def other_machine() -> MachineFile:
    machine = shipped_machine()
    return machine.model_copy(update={"legs": machine.legs.model_copy(update={"length_mm": 410.0})})


def test_machine_of_other_dimensions_is_refused(record: Record) -> None:
    record.require_machine(shipped_machine().model_copy(update={"name": "renamed", "can": None}), "model.toml")
    message = error_of(lambda: record.require_machine(other_machine(), "model.toml"))
    assert message == "model.toml: legs.length_mm: 410 (expected 400, as in record: they do not belong together)"


BAD_VALUES = [
    ("reading_um", 3, np.nan, "row 4: reading_um: nan (expected a finite number)"),
    ("s3_mm", 0, np.inf, "row 1: s3_mm: inf (expected a finite number)"),
    ("direction", 30, 0, "row 31: direction: 0 (expected 1 (counter-clockwise) or -1 (clockwise))"),
    ("circle", 10, 4, "row 11: circle: 4 (expected the id of a circle: 0)"),
    ("reading_um", 49, 1000.5, "row 50: reading_um: 1000.5 (expected a reading within the gauge's range of ±1000 µm)"),
    ("reading_um", 49, -1001, "row 50: reading_um: -1001 (expected a reading within"),
    ("s6_mm", 5, 848.0, "row 6: s6_mm: 848 (expected within the travel of the machine's sliders, 20 to 846 mm)"),
    ("s1_mm", 5, 0.4, "row 6: s1_mm: 0.4 (expected within the travel"),
    ("t_s", 8, 0.028, "row 9: t_s: 0.028 (expected a time after 0.028, the row before)"),
    ("t_s", 25, 0.01, "row 26: t_s: 0.01 (expected a time not before 0.096, the row before)"),
    ("feed_mm_min", 0, 0.0, "row 1: feed_mm_min: 0 (expected a number > 0)"),
    ("feed_mm_min", 20, 3000.0, "row 21: feed_mm_min: 3000 (expected one value throughout its sweep"),
    ("direction", 20, 1, "row 21: direction: 1 (expected one value throughout its sweep"),
]


@pytest.mark.parametrize(("column", "row", "value", "message"), BAD_VALUES)
def test_bad_sample_is_refused_on_writing_and_on_reading(
    record: Record, tmp_path: Path, column: str, row: int, value: float, message: str
) -> None:
    record.columns[column][row] = value
    assert error_of(lambda: write_record(record, tmp_path / "a.parquet")).startswith(f"record: {message}")
    assert list(tmp_path.iterdir()) == []
    good = written(fresh(record), tmp_path / "a.parquet")
    metadata = pq.read_schema(good).metadata
    del metadata[b"hexdbb.digests"]  # as another program's record, which states none
    pq.write_table(pa.table(record.columns, metadata=metadata), good)
    assert error_of(lambda: read_record(good)).startswith(f"{good}: {message}")


def fresh(record: Record) -> Record:
    """Return one row of the record that is as it should be, for its file metadata."""
    row = next(row for row in range(len(record)) if row not in {bad[1] for bad in BAD_VALUES})
    return replace(record, columns={name: values[row : row + 1] for name, values in record.columns.items()})


def test_two_circles_in_one_sweep_are_refused(record: Record) -> None:
    second = record.circles[0].model_copy(update={"id": 1})
    record.columns["circle"][12] = 1
    two = replace(record, circles=(*record.circles, second))
    message = error_of(lambda: write_record(two, "never.parquet"))
    assert message.startswith("record: row 13: circle: 1 (expected one value throughout its sweep")


def test_missing_and_uneven_columns_are_refused(record: Record) -> None:
    without = {name: values for name, values in record.columns.items() if name not in ("s2_mm", "lap")}
    assert error_of(lambda: replace(record, columns=without)).startswith(
        "record: missing column lap, s2_mm (columns pr"
    )
    uneven = {**record.columns, "s2_mm": record.columns["s2_mm"][:-1]}
    assert "column s2_mm: shape (49,) (expected (50,), as t_s has)" in error_of(lambda: replace(record, columns=uneven))
    texts = {**record.columns, "s2_mm": np.full(50, "a")}
    assert "column s2_mm: of type <U1 (expected numbers)" in error_of(lambda: replace(record, columns=texts))
    half = {**record.columns, "lap": np.full(50, 0.5)}
    assert "record: row 1: lap: 0.5 (expected a whole number" in error_of(lambda: replace(record, columns=half))


def test_files_that_are_no_records_are_refused(record: Record, tmp_path: Path) -> None:
    plain, torn = tmp_path / "plain.parquet", tmp_path / "torn.parquet"
    pq.write_table(pa.table({"a": [1]}), plain)
    assert error_of(lambda: read_record(plain)).startswith(f"{plain}: not a record")
    torn.write_bytes(written(record, tmp_path / "a.parquet").read_bytes()[:-100])
    assert error_of(lambda: read_record(torn)).startswith(f"{torn}: not a whole Parquet file")
    assert error_of(lambda: read_record(tmp_path / "none.parquet")).endswith("none.parquet: no such file")
    assert "suffix '.txt' (expected a record: .parquet, .csv, .xlsx)" in error_of(lambda: read_record("a.txt"))
    assert "hexdbb recover a.parquet.journal" in error_of(lambda: read_record("a.parquet.journal"))
    assert "no such directory" in error_of(lambda: write_record(record, tmp_path / "none" / "a.parquet"))


def test_record_of_a_later_format_is_refused(record: Record, tmp_path: Path) -> None:
    path = written(record, tmp_path / "a.parquet")
    table = pq.read_table(path)
    later = table.schema.metadata[b"hexdbb"].replace(b"hexdbb.record/1", b"hexdbb.record/2")
    pq.write_table(table.replace_schema_metadata({**table.schema.metadata, b"hexdbb": later}), path)
    assert 'format: "hexdbb.record/2" (expected a record of the format "hexdbb.record/1")' in error_of(
        lambda: read_record(path)
    )


def test_a_part_counts_as_the_record_it_is_of(record: Record) -> None:
    second = record.columns["sweep"] == 1
    part = record.part(second)
    assert len(part) == second.sum()
    assert part.content_hash() == record.content_hash()
    assert part.part(np.arange(len(part)) < 5).content_hash() == record.content_hash()
