"""The samples of a record are checked once on each way: capture, reading, writing, recovery, conversion."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from click.testing import CliRunner

from hexdbb.cli import convert, recover
from hexdbb.errors import RunError
from hexdbb.record import Journal, Record, read_record, write_record
from hexdbb.record import checks as record_checks


def capture_of(record: Record, path: Path) -> Journal:
    return Journal(path, machine=record.machine, gauge=record.gauge, mounts=record.mounts, circles=record.circles)


@pytest.fixture
def checks(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Sizes of the records whose samples are checked while a test runs."""
    made: list[int] = []
    findings = record_checks._findings

    def counted(record: Record) -> Iterator[record_checks.Finding]:
        made.append(len(record))
        return findings(record)

    monkeypatch.setattr(record_checks, "_findings", counted)
    return made


def test_a_finished_capture_is_checked_once(record: Record, tmp_path: Path, checks: list[int]) -> None:
    with capture_of(record, tmp_path / "a.parquet") as journal:
        journal.append(record.columns)
        journal.finish()
    assert checks == [len(record)]


def test_a_capture_with_a_wrong_sample_is_checked_once(record: Record, tmp_path: Path, checks: list[int]) -> None:
    record.columns["reading_um"][33] = 5000.0
    with capture_of(record, tmp_path / "a.parquet") as journal:
        journal.append(record.columns)
        assert len(journal.finish()) == 33
    assert checks == [len(record)]


@pytest.mark.parametrize("suffix", [".parquet", ".csv"])
def test_reading_and_writing_check_once_each(record: Record, tmp_path: Path, checks: list[int], suffix: str) -> None:
    write_record(record, tmp_path / f"a{suffix}")
    assert checks == [len(record)]
    read_record(tmp_path / f"a{suffix}")
    assert checks == [len(record)] * 2


def test_recovering_and_converting_check_once_each(record: Record, tmp_path: Path, checks: list[int]) -> None:
    with capture_of(record, tmp_path / "a.parquet") as journal:
        journal.append(record.columns)
    done = CliRunner().invoke(recover.command, [str(journal.journal_path)])
    assert done.exit_code == 0, done.output
    assert checks == [len(record)]
    done = CliRunner().invoke(convert.command, [str(tmp_path / "a.parquet"), str(tmp_path / "b.csv")])
    assert done.exit_code == 0, done.output
    assert checks == [len(record)] * 2


def test_a_first_sample_that_is_wrong_leaves_the_journal(record: Record, tmp_path: Path) -> None:
    record.columns["direction"][0] = 0
    with capture_of(record, tmp_path / "a.parquet") as journal:
        journal.append(record.columns)
        with pytest.raises(RunError, match=r"row 1: direction: 0 \(expected 1.*the journal is kept"):
            journal.finish()
    assert list(tmp_path.iterdir()) == [journal.journal_path]
