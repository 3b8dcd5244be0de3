from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from tests.programs import called

from hexdbb.record import Journal, Record, journal_path, read_record, write_record


def hexdbb(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    return called("hexdbb", *arguments)


def test_record_to_text_form_and_back(record: Record, tmp_path: Path) -> None:
    write_record(record, tmp_path / "a.parquet")
    there = hexdbb("convert", tmp_path / "a.parquet", tmp_path / "b.csv")
    assert (there.returncode, there.stderr) == (0, "")
    assert f"{tmp_path}/b.csv: 50 samples, 2 sweeps" in there.stdout
    assert {file.name for file in tmp_path.iterdir()} == {"a.parquet", "b.csv", "b.toml", "b.machine.toml"}
    back = hexdbb("convert", tmp_path / "b.csv", tmp_path / "c.parquet")
    assert (back.returncode, back.stderr) == (0, "")
    assert read_record(tmp_path / "c.parquet").content_hash() == record.content_hash()


@pytest.mark.parametrize(
    ("source", "target", "message"),
    [
        ("none.csv", "b.parquet", "none.csv: no such file"),
        ("a.parquet", "b.ods", "b.ods: suffix '.ods' (expected a record: .parquet, .csv, .xlsx)"),
        ("a.parquet", "a.parquet", "a.parquet: exists already"),
        ("a.parquet", "none/b.csv", "b.csv: no such directory"),
    ],
)
def test_wrong_use_is_one_line_and_status_2_and_nothing_is_written(
    record: Record, tmp_path: Path, source: str, target: str, message: str
) -> None:
    write_record(record, tmp_path / "a.parquet")
    before = (tmp_path / "a.parquet").read_bytes()
    done = hexdbb("convert", tmp_path / source, tmp_path / target)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("error: ")
    assert message in done.stderr
    assert done.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == [tmp_path / "a.parquet"]
    assert (tmp_path / "a.parquet").read_bytes() == before


def test_overwrite_is_possible_when_asked_for(record: Record, tmp_path: Path) -> None:
    write_record(record, tmp_path / "a.parquet")
    write_record(record, tmp_path / "b.csv")
    assert hexdbb("convert", "--overwrite", tmp_path / "a.parquet", tmp_path / "b.csv").returncode == 0


def interrupted(record: Record, path: Path) -> Path:
    setup = {"machine": record.machine, "gauge": record.gauge, "mounts": record.mounts, "circles": record.circles}
    with Journal(path, **setup) as journal:
        journal.append(record.columns)
    return journal_path(path)


def test_interrupted_capture_is_recovered_beside_its_journal(record: Record, tmp_path: Path) -> None:
    journal = interrupted(record, tmp_path / "a.parquet")
    done = hexdbb("recover", journal)
    assert (done.returncode, done.stderr) == (0, "")
    assert "50 samples, the last at 0.196 s, marked incomplete" in done.stdout
    assert "reason: the capture was interrupted" in done.stdout
    assert not read_record(tmp_path / "a.parquet").complete
    assert journal.exists()
    again = hexdbb("recover", journal)
    assert again.returncode == 2
    assert "exists already" in again.stderr


def test_recovered_record_may_have_another_name_and_form(record: Record, tmp_path: Path) -> None:
    journal = interrupted(record, tmp_path / "a.parquet")
    assert hexdbb("recover", journal, "-o", tmp_path / "saved.csv").returncode == 0
    saved = read_record(tmp_path / "saved.csv")
    assert (len(saved), saved.complete) == (50, False)


def test_file_that_is_no_journal_is_refused(record: Record, tmp_path: Path) -> None:
    write_record(record, tmp_path / "a.parquet")
    (tmp_path / "plain.journal").write_text("no journal")
    for arguments, message in [
        ((tmp_path / "a.parquet",), "not named RECORD.journal"),
        ((tmp_path / "a.parquet", "-o", tmp_path / "b.parquet"), "is whole (expected a damaged record"),
        ((tmp_path / "a.parquet", "-o", tmp_path / "a.parquet", "--overwrite"), "is the file to recover"),
        ((tmp_path / "plain.journal", "-o", tmp_path / "b.parquet"), "holds no samples"),
        ((tmp_path / "none.parquet.journal",), "no such file"),
    ]:
        done = hexdbb("recover", *arguments)
        assert done.returncode == 2
        assert message in done.stderr
        assert done.stderr.count("\n") == 1


@pytest.mark.parametrize("name", ["convert", "recover"])
def test_help_has_examples(name: str) -> None:
    done = hexdbb(name, "--help")
    assert done.returncode == 0
    assert f"hexdbb {name} demo.parquet" in done.stdout
