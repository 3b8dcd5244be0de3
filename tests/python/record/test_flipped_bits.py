"""One flipped bit anywhere in a record or a journal is refused or changes nothing, and what is whole is recovered."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from hexdbb.errors import InputError
from hexdbb.record import Journal, Record, read_record, recover, write_record
from hexdbb.record import parquet as parquet_form

FLIPS = 150
ROWS = 600


@pytest.fixture
def long_record(record: Record) -> Record:
    """The samples of the small record again and again, with every optional column and two of a user's own."""
    times = ROWS // len(record)
    columns = {name: np.tile(values, times) for name, values in record.columns.items()}
    count = len(columns["t_s"])
    rng = np.random.default_rng(5)
    columns |= {"t_s": np.arange(count) * 0.004, "sweep": np.arange(count) // 25, "reading_um": rng.normal(size=count)}
    columns |= {"temperature_c": rng.normal(20.0, 1.0, count), "status": np.zeros(count, np.int32)}
    columns |= {"note": np.array([f"row {row}" for row in range(count)], object), "load": rng.normal(size=count)}
    return replace(record, columns=columns, origin=None)


def flipped(content: bytes, rng: random.Random) -> bytes:
    data = bytearray(content)
    data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    return bytes(data)


def facts(record: Record) -> tuple[object, ...]:
    """Everything but the samples that an analysis takes from a record."""
    metadata = {key: value for key, value in record.metadata.items() if key != "incomplete_because"}
    return (record.gauge, record.mounts, record.circles, record.machine, metadata)


def is_part_of(part: Record, whole: Record) -> bool:
    """Whether every row of `part` is a row of `whole`, bit by bit, and all else it holds is the same."""
    rows = np.searchsorted(whole.columns["t_s"], part.columns["t_s"])
    same = all(np.array_equal(values, whole.columns[name][rows]) for name, values in part.columns.items())
    return same and facts(part) == facts(whole)


def read_or_refused(reader: Callable[[Path], Record], path: Path) -> Record | None:
    try:
        return reader(path)
    except InputError as error:
        assert "\n" not in str(error)
        assert str(error).startswith(str(path))
        return None


def test_no_flipped_bit_of_a_parquet_record_changes_a_value_unnoticed(
    long_record: Record, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(parquet_form, "ROWS_PER_GROUP", 150)
    path, rng = tmp_path / "a.parquet", random.Random(1)
    write_record(long_record, path)
    original, content = read_record(path), path.read_bytes()
    pages = first_page(path)  # before it is the copy of the footer, which is only read where the footer is damaged
    refused = saved = needed = 0
    for _ in range(FLIPS):
        damaged = flipped(content, rng)
        needed += damaged[pages:] != content[pages:]
        path.write_bytes(damaged)
        again = read_or_refused(read_record, path)
        if again is not None:
            assert len(again) == len(original)
            assert again.complete
            assert list(again.columns) == list(original.columns)
            assert is_part_of(again, original)
            continue
        refused += 1
        rest = read_or_refused(recover, path)
        if rest is not None:
            saved += 1
            assert not rest.complete
            assert "damaged" in rest.metadata["incomplete_because"]
            assert is_part_of(rest, original)
    assert needed > FLIPS / 2
    assert refused > needed / 2  # the others hit what the footer states beyond what is read, such as extremes
    assert saved > refused / 2


def first_page(path: Path) -> int:
    with pq.ParquetFile(path) as file:
        first = file.metadata.row_group(0).column(0)
        return int(first.dictionary_page_offset or first.data_page_offset)


def footer_of(content: bytes) -> tuple[int, int]:
    """Return where the footer of a Parquet file begins and ends."""
    end = len(content) - 8
    return end - int.from_bytes(content[end : end + 4], "little"), end


def test_a_record_whose_end_is_missing_or_damaged_is_recovered_whole(long_record: Record, tmp_path: Path) -> None:
    path, rng = tmp_path / "a.parquet", random.Random(4)
    write_record(long_record, path)
    original, content = read_record(path), path.read_bytes()
    begin, end = footer_of(content)
    cut = [content[:at] for at in (begin, begin + 1, (begin + end) // 2, end, end + 3, len(content) - 1)]
    flips = []
    for _ in range(FLIPS):
        data = bytearray(content)
        data[rng.randrange(begin, len(data))] ^= 1 << rng.randrange(8)
        flips.append(bytes(data))
    saved = 0
    for damaged in [*cut, *flips]:
        path.write_bytes(damaged)
        again = read_or_refused(read_record, path)
        if again is not None:
            assert is_part_of(again, original), "what is read in spite of the damage is right"
            continue
        rest = recover(path)
        saved += 1
        assert len(rest) == len(original)
        assert is_part_of(rest, original)
        assert not rest.complete
        assert (
            "read by its copy" in rest.metadata["incomplete_because"]
            or "left out" in rest.metadata["incomplete_because"]
        )
    assert saved > len(cut) + FLIPS / 2


def test_of_a_record_cut_short_the_row_groups_before_the_cut_are_recovered(
    long_record: Record, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(parquet_form, "ROWS_PER_GROUP", 150)
    path = tmp_path / "a.parquet"
    write_record(long_record, path)
    original, content = read_record(path), path.read_bytes()
    with pq.ParquetFile(path) as file:
        third = file.metadata.row_group(2).column(0)
        begin = third.dictionary_page_offset or third.data_page_offset
    path.write_bytes(content[: begin + 10])
    with pytest.raises(InputError, match=r"not a whole Parquet file.*save what is whole with: hexdbb recover"):
        read_record(path)
    rest = recover(path)
    assert len(rest) == 300
    assert is_part_of(rest, original)


def test_where_footer_and_copy_are_damaged_nothing_is_invented(long_record: Record, tmp_path: Path) -> None:
    path = tmp_path / "a.parquet"
    write_record(long_record, path)
    content = bytearray(path.read_bytes())
    content[200] ^= 1
    path.write_bytes(content[:-20])
    with pytest.raises(InputError, match=r"its index is damaged"):
        recover(path)


def test_a_footer_that_needs_more_room_than_expected_is_copied_all_the_same(
    long_record: Record, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("hexdbb.record.footer_copy.CHUNK_BYTES", 0)
    monkeypatch.setattr("hexdbb.record.footer_copy.SPARE_BYTES", 0)
    path = tmp_path / "a.parquet"
    write_record(long_record, path)
    path.write_bytes(path.read_bytes()[:-1])
    assert len(recover(path)) == len(long_record)


def journal_of(record: Record, path: Path, rows: int = 100) -> bytes:
    """Return the bytes of a journal of the record, its batches of `rows` rows."""
    setup = {"machine": record.machine, "gauge": record.gauge, "mounts": record.mounts, "circles": record.circles}
    with Journal(path, metadata=record.metadata, **setup) as journal:
        for first in range(0, len(record), rows):
            journal.append({name: values[first : first + rows] for name, values in record.columns.items()})
            journal._write_queued()
    return journal.journal_path.read_bytes()


@pytest.fixture
def writes_when_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """The journal's own thread writes nothing before the end, so that batches are those of the test."""
    monkeypatch.setattr("hexdbb.record.journal.WRITE_PERIOD_S", 1e3)


@pytest.mark.usefixtures("writes_when_told")
def test_no_flipped_bit_of_a_journal_changes_a_value_unnoticed(long_record: Record, tmp_path: Path) -> None:
    content, rng = journal_of(long_record, tmp_path / "a.parquet"), random.Random(2)
    path = tmp_path / "a.parquet.journal"
    original, least = recover(path), len(long_record) - 100
    assert len(original) == len(long_record)
    whole = 0
    for _ in range(FLIPS):
        path.write_bytes(flipped(content, rng))
        again = recover(path)
        assert is_part_of(again, original)
        assert len(again) >= least, "one damaged batch costs no other"
        whole += len(again) == len(original)
    assert whole < FLIPS / 2


@pytest.mark.usefixtures("writes_when_told")
def test_damage_in_the_midst_of_a_journal_is_named_with_rows_and_column(long_record: Record, tmp_path: Path) -> None:
    content = journal_of(long_record, tmp_path / "a.parquet")
    reading = long_record.columns["reading_um"][250:251].tobytes()
    at = content.index(reading)
    path = tmp_path / "a.parquet.journal"
    path.write_bytes(content[:at] + bytes([content[at] ^ 1]) + content[at + 1 :])
    rest = recover(path)
    assert len(rest) == len(long_record) - 100
    assert "rows 201 to 300 (column reading_um)" in rest.metadata["incomplete_because"]


@pytest.mark.usefixtures("writes_when_told")
def test_a_capture_whose_journal_was_damaged_is_not_complete(long_record: Record, tmp_path: Path) -> None:
    content = journal_of(long_record, tmp_path / "a.parquet")
    at = content.index(long_record.columns["reading_um"][-5:-4].tobytes())
    setup = {key: getattr(long_record, key) for key in ("machine", "gauge", "mounts", "circles")}
    with Journal(tmp_path / "b.parquet", metadata=long_record.metadata, **setup) as journal:
        for first in range(0, len(long_record), 100):
            journal.append({name: values[first : first + 100] for name, values in long_record.columns.items()})
            journal._write_queued()
        journal.close()
        path = journal.journal_path
        path.write_bytes(content[:at] + bytes([content[at] ^ 1]) + content[at + 1 :])
        record = journal.finish()
    assert (record.complete, len(record)) == (False, len(long_record) - 100)
    assert "rows 501 to 600" in record.metadata["incomplete_because"]
    assert path.exists(), "the journal is kept"


def damaged_in(path: Path, column: str, group: int) -> None:
    """Flip a bit in the midst of a column's values of one row group (from 0)."""
    with pq.ParquetFile(path) as file:
        names = file.schema_arrow.names
        chunk = file.metadata.row_group(group).column(names.index(column))
    content = bytearray(path.read_bytes())
    content[(chunk.dictionary_page_offset or chunk.data_page_offset) + chunk.total_compressed_size // 2] ^= 4
    path.write_bytes(content)


def test_damage_names_column_and_row_group_and_costs_that_row_group_only(
    long_record: Record, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(parquet_form, "ROWS_PER_GROUP", 150)
    path = tmp_path / "a.parquet"
    write_record(long_record, path)
    damaged_in(path, "reading_um", 2)
    with pytest.raises(InputError, match=r"column reading_um, row group 3: damaged .*hexdbb recover .*a\.parquet -o"):
        read_record(path)
    rest = recover(path)
    expected = np.delete(long_record.columns["t_s"], np.s_[300:450])
    np.testing.assert_array_equal(rest.columns["t_s"], expected)
    assert rest.metadata["incomplete_because"].endswith("row group 3 left out (reading_um damaged)")


def test_a_damaged_optional_column_is_left_out_and_every_row_stays(
    long_record: Record, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(parquet_form, "ROWS_PER_GROUP", 150)
    path = tmp_path / "a.parquet"
    write_record(long_record, path)
    damaged_in(path, "load", 1)
    rest = recover(path)
    assert set(long_record.columns) - set(rest.columns) == {"load"}
    assert len(rest) == len(long_record)
    assert rest.metadata["incomplete_because"].endswith("column load left out")


def test_changed_metadata_of_a_record_are_refused(long_record: Record, tmp_path: Path) -> None:
    path = tmp_path / "a.parquet"
    write_record(long_record, path)
    table = pq.read_table(path)
    metadata = {**table.schema.metadata}
    metadata[b"hexdbb.machine"] = metadata[b"hexdbb.machine"].replace(b"length_mm = 400.0", b"length_mm = 401.0")
    pq.write_table(table.replace_schema_metadata(metadata), path)
    with pytest.raises(InputError, match=r"metadata hexdbb\.machine: damaged or changed"):
        read_record(path)
    with pytest.raises(InputError, match="nothing can be saved"):
        recover(path)


def test_records_and_journals_of_earlier_versions_are_read(long_record: Record, tmp_path: Path) -> None:
    path, journal = tmp_path / "a.parquet", tmp_path / "a.parquet.journal"
    write_record(long_record, path)
    table = pq.read_table(path)
    metadata = {key: value for key, value in table.schema.metadata.items() if key != b"hexdbb.digests"}
    table = table.replace_schema_metadata(metadata)
    pq.write_table(table, path, compression="zstd")
    assert len(read_record(path)) == len(long_record)
    with pa.OSFile(str(journal), "wb") as file, pa.ipc.new_stream(file, table.schema) as stream:
        stream.write_table(table, max_chunksize=100)
    assert len(recover(journal)) == len(long_record)
