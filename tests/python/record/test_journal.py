from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path

import numpy as np
import pytest

from hexdbb.errors import InputError, RunError
from hexdbb.record import Journal, Record, journal_path, read_record, recover, write_record

PATIENCE_S = 30.0
"""Longest a test waits for what takes a second at most."""


def journal_of(record: Record, path: Path, overwrite: bool = False) -> Journal:
    return Journal(
        path,
        machine=record.machine,
        gauge=record.gauge,
        mounts=record.mounts,
        circles=record.circles,
        metadata=record.metadata,
        overwrite=overwrite,
    )


def part(record: Record, rows: slice) -> dict[str, np.ndarray]:
    return {name: values[rows] for name, values in record.columns.items()}


def wait_for(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < deadline, "did not happen"
        time.sleep(0.02)


def rows_on_disk(journal: Path) -> int:
    """Count the rows of a journal that is being written, in a copy of it."""
    copy = journal.with_suffix(".copy")
    copy.write_bytes(journal.read_bytes())
    try:
        return len(recover(copy))
    except InputError:
        return 0
    finally:
        copy.unlink()


def batches_on_disk(record: Record, path: Path, cuts: list[int]) -> Path:
    """Leave a journal whose batches end at the given rows."""
    with journal_of(record, path) as journal:
        for first, last in zip([0, *cuts], cuts, strict=False):
            journal.append(part(record, slice(first, last)))
            wait_for(lambda last=last: rows_on_disk(journal.journal_path) == last)
    return journal.journal_path


def test_finished_journal_becomes_the_record(record: Record, tmp_path: Path) -> None:
    path = tmp_path / "a.parquet"
    with journal_of(record, path) as journal:
        for row in range(len(record)):
            journal.append({name: values[row] for name, values in record.columns.items()})
        finished = journal.finish()
    assert finished.complete
    assert finished.path == path
    assert list(tmp_path.iterdir()) == [path]
    again = read_record(path)
    assert again.content_hash() == finished.content_hash() == record.content_hash()
    assert again.complete
    assert again.metadata["can"] == {"bus": "none"}
    assert "incomplete_because" not in again.metadata


def test_stopped_capture_is_marked_with_its_reason(record: Record, tmp_path: Path) -> None:
    with journal_of(record, tmp_path / "a.parquet") as journal:
        journal.append(part(record, slice(0, 30)))
        journal.finish(complete=False, reason="node 3: fault 8611h")
    again = read_record(tmp_path / "a.parquet")
    assert not again.complete
    assert again.metadata["incomplete_because"] == "node 3: fault 8611h"
    assert len(again) == 30


KILLED = """
import sys, time
from hexdbb.record import Journal, read_record
record = read_record(sys.argv[1])
journal = Journal(sys.argv[2], machine=record.machine, gauge=record.gauge, mounts=record.mounts, circles=record.circles)
for row in range(30):
    journal.append({name: values[row] for name, values in record.columns.items()})
print("appended", flush=True)
time.sleep(600)
"""


def test_killed_capture_is_recovered_without_having_been_told_to_flush(record: Record, tmp_path: Path) -> None:
    source, target = tmp_path / "source.parquet", tmp_path / "a.parquet"
    write_record(record, source)
    with subprocess.Popen([sys.executable, "-c", KILLED, source, target], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "appended\n"
        wait_for(lambda: rows_on_disk(journal_path(target)) == 30)
        with pytest.raises(InputError, match="in use by a running capture"):
            recover(journal_path(target))
        with pytest.raises(InputError, match="in use by a running capture"):
            journal_of(record, target, overwrite=True)
        process.send_signal(signal.SIGKILL)
    recovered = recover(journal_path(target))
    assert not recovered.complete
    assert recovered.metadata["incomplete_because"] == "the capture was interrupted"
    for name, values in recovered.columns.items():
        np.testing.assert_array_equal(values, record.columns[name][:30])
    assert journal_path(target).exists()


def test_torn_at_any_byte_every_whole_batch_is_recovered(record: Record, tmp_path: Path) -> None:
    cuts = [10, 20, 30]
    whole = batches_on_disk(record, tmp_path / "a.parquet", cuts).read_bytes()
    torn = tmp_path / "torn.journal"
    found = []
    for size in [*range(0, len(whole), 37), len(whole)]:
        torn.write_bytes(whole[:size])
        try:
            recovered = recover(torn)
        except InputError as error:
            assert "holds no samples" in str(error)
            found.append(0)
        else:
            np.testing.assert_array_equal(recovered.columns["t_s"], record.columns["t_s"][: len(recovered)])
            found.append(len(recovered))
    assert found == sorted(found)
    assert set(found) == {0, *cuts}


def test_tail_of_rubbish_is_left_out(record: Record, tmp_path: Path) -> None:
    cuts = [10, 20]
    path = batches_on_disk(record, tmp_path / "a.parquet", cuts)
    whole = path.read_bytes()
    for tail in (b"\x00" * 500, b"\xff" * 500, bytes(range(256)) * 4):
        path.write_bytes(whole[: len(whole) - 8] + tail)
        assert len(recover(path)) == 20


def test_samples_from_the_first_wrong_one_on_are_left_out_and_the_journal_stays(record: Record, tmp_path: Path) -> None:
    record.columns["reading_um"][33] = 5000.0
    with journal_of(record, tmp_path / "a.parquet") as journal:
        journal.append(record.columns)
        finished = journal.finish()
    assert (len(finished), finished.complete) == (33, False)
    assert "row 34: reading_um: 5000 (expected a reading within" in finished.metadata["incomplete_because"]
    assert journal.journal_path.exists()
    assert len(recover(journal.journal_path)) == 33


def test_capture_without_samples_leaves_nothing(record: Record, tmp_path: Path) -> None:
    with (
        journal_of(record, tmp_path / "a.parquet") as journal,
        pytest.raises(RunError, match="no samples were captured"),
    ):
        journal.finish()
    with journal_of(record, tmp_path / "a.parquet"):
        pass
    assert list(tmp_path.iterdir()) == []


def test_what_stands_there_is_not_overwritten_unasked(record: Record, tmp_path: Path) -> None:
    path = tmp_path / "a.parquet"
    write_record(record, path)
    with pytest.raises(InputError, match=r"a\.parquet: exists already"):
        journal_of(record, path)
    with journal_of(record, path, overwrite=True) as journal:
        journal.append(part(record, slice(0, 20)))
        journal.finish()
    assert len(read_record(path)) == 20


def test_journal_of_an_interrupted_capture_is_not_lost(record: Record, tmp_path: Path) -> None:
    with journal_of(record, tmp_path / "a.parquet") as journal:
        journal.append(record.columns)
    with pytest.raises(InputError, match=r"left by an interrupted capture .*hexdbb recover .*a\.parquet\.journal"):
        journal_of(record, tmp_path / "a.parquet")
    assert len(recover(journal.journal_path)) == len(record)


def test_capture_killed_before_its_first_samples_is_no_dead_end(record: Record, tmp_path: Path) -> None:
    place = journal_path(tmp_path / "a.parquet")
    for begun, kept in ((b"", []), (b"\xff\xff\xff\xff\x40", [b"\xff\xff\xff\xff\x40"])):
        place.write_bytes(begun)
        with journal_of(record, tmp_path / "a.parquet", overwrite=True) as journal:
            journal.append(record.columns)
            assert len(journal.finish()) == len(record)
        assert [path.read_bytes() for path in tmp_path.glob("a.parquet.journal*")] == kept


def test_overwriting_sets_a_journal_with_samples_aside(record: Record, tmp_path: Path) -> None:
    for number in (1, 2):
        with journal_of(record, tmp_path / "a.parquet", overwrite=True) as journal:
            journal.append(part(record, slice(0, 10 * number)))
        again = journal_of(record, tmp_path / "a.parquet", overwrite=True)
        assert again.set_aside == tmp_path / f"a.parquet.journal.{number}"
        assert len(recover(again.set_aside)) == 10 * number
        again.close()


def test_disk_full_at_the_end_names_the_journal(
    record: Record, tmp_path: Path, disk_full_after: Callable[[int], AbstractContextManager[None]]
) -> None:
    with journal_of(record, tmp_path / "a.parquet") as journal:
        journal.append(record.columns)
        journal.close()
        with (
            disk_full_after(100),
            pytest.raises(RunError, match=r"a\.parquet: cannot be written.*hexdbb recover .*journal$"),
        ):
            journal.finish()
    assert len(recover(journal.journal_path)) == len(record)


def test_places_that_cannot_be_written_are_refused(record: Record, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such directory"):
        journal_of(record, tmp_path / "none" / "a.parquet")
    with pytest.raises(InputError, match=r"suffix '\.csv' \(expected \.parquet\)"):
        journal_of(record, tmp_path / "a.csv")


def test_columns_must_stay_the_same(record: Record, tmp_path: Path) -> None:
    with journal_of(record, tmp_path / "a.parquet") as journal:
        with pytest.raises(InputError, match="missing column lap"):
            journal.append({name: values for name, values in record.columns.items() if name != "lap"})
        journal.append(record.columns)
        with pytest.raises(InputError, match=r"status.* \(expected t_s"):
            journal.append({**record.columns, "status": np.zeros(len(record))})


def test_closed_journal_takes_no_more(record: Record, tmp_path: Path) -> None:
    journal = journal_of(record, tmp_path / "a.parquet")
    journal.close()
    with pytest.raises(RunError, match="closed"):
        journal.append(record.columns)


def test_full_disk_reaches_the_capture_and_what_was_written_is_kept(
    record: Record, tmp_path: Path, disk_full_after: Callable[[int], AbstractContextManager[None]]
) -> None:
    journal = journal_of(record, tmp_path / "a.parquet")
    journal.append(part(record, slice(0, 20)))
    wait_for(lambda: rows_on_disk(journal.journal_path) == 20)
    with disk_full_after(journal.journal_path.stat().st_size + 100):
        journal.append(part(record, slice(20, 50)))
        journal.close()
    with pytest.raises(RunError, match=r"cannot be written: .*File too large.*hexdbb recover"):
        journal.append(part(record, slice(40, 50)))
    with pytest.raises(RunError, match="cannot be written"):
        journal.finish()
    assert len(recover(journal.journal_path)) == 20


def test_metadata_that_json_cannot_hold_are_refused_before_the_capture(record: Record, tmp_path: Path) -> None:
    record.metadata["bus"] = object()
    with pytest.raises(ValueError, match="serialize"):
        journal_of(record, tmp_path / "a.parquet")
    assert list(tmp_path.iterdir()) == []
