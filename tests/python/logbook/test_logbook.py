"""The logbook's folder: content once, nothing lost, what half a synchronisation leaves, two processes, wrong files."""

from __future__ import annotations

import json
import shutil
import sqlite3
from dataclasses import replace
from pathlib import Path

import pytest
from tests.programs import called

from hexdbb.cli.run_logged import filing_in
from hexdbb.errors import InputError, RunError
from hexdbb.files.validation import dump_toml
from hexdbb.logbook import Logbook, index
from hexdbb.model import new_model, save_model
from hexdbb.record import Record, read_record, write_record

DATE = "2026-03-01"


@pytest.fixture
def parquet(record: Record, tmp_path: Path) -> Path:
    path = tmp_path / "monday.parquet"
    write_record(replace(record, metadata={"started": f"{DATE}T08:00:00+00:00", "plan": "thesis"}), path)
    return path


@pytest.fixture
def book(parquet: Path) -> Logbook:
    assert called("hexdbb", "log", "add", "glider", parquet.name, folder=parquet.parent).returncode == 0
    return Logbook(parquet.parent / "glider")


def log(book: Logbook, *words: object) -> tuple[int, str, str]:
    done = called("hexdbb", "log", *words, folder=book.folder.parent)
    return done.returncode, done.stdout, done.stderr


def test_a_record_is_kept_as_it_is_under_its_content(book: Logbook, parquet: Path) -> None:
    (entry,) = book.entries()
    assert entry.sha256 == read_record(parquet).content_hash()
    assert book.path_of(entry).read_bytes() == parquet.read_bytes()
    assert (entry.kind, entry.name, entry.measured[:10]) == ("record", "monday.parquet", DATE)
    assert book.records()[0].month == "2026-03"


def test_the_same_content_is_one_entry_in_every_format_and_said_so(book: Logbook, parquet: Path) -> None:
    write_record(read_record(parquet), parquet.with_name("copy.csv"))
    before = sorted(book.folder.rglob("*"))
    status, out, _ = log(book, "add", "glider", "copy.csv", "monday.parquet")
    assert status == 0
    assert out.count("in glider already, added as monday.parquet") == 2
    assert sorted(book.folder.rglob("*")) == before
    assert len(book.entries()) == 1


def test_a_text_form_is_kept_as_parquet_with_the_date_given(record: Record, tmp_path: Path) -> None:
    write_record(record, tmp_path / "old.csv")
    done = called("hexdbb", "log", "add", "glider", "old.csv", folder=tmp_path)
    assert done.returncode == 2
    assert "does not say when it was measured (expected --date" in done.stderr
    done = called("hexdbb", "log", "add", "glider", "old.csv", "--date", DATE, folder=tmp_path)
    assert done.returncode == 0, done.stderr
    book = Logbook(tmp_path / "glider")
    (path,) = (book.folder / "records").iterdir()
    assert path.suffix == ".parquet"
    assert read_record(path).metadata["started"].startswith(DATE)
    book.index.path.unlink()  # the date is in the file, so that an index made anew has it
    assert log(book, "check", "glider")[0] == 0
    assert book.entries()[0].measured[:10] == DATE


def test_models_and_verdicts_are_kept_by_their_bytes(book: Logbook, record: Record) -> None:
    folder = book.folder.parent
    save_model(new_model(record.machine), folder / "model.toml")
    (folder / "verdict.json").write_text(json.dumps({"schema": "hexdbb.discover/2", "verdict": "none"}))
    assert log(book, "add", "glider", "model.toml", "verdict.json")[0] == 0
    assert [each.kind for each in book.entries()] == ["record", "model", "verdict"]
    model = next(each for each in book.entries() if each.kind == "model")
    assert book.path_of(model).read_bytes() == (folder / "model.toml").read_bytes()
    status, out, _ = log(book, "show", "glider", model.sha256[:6], "--json")
    (shown,) = json.loads(out)["entries"]
    assert status == 0
    assert (shown["sha256"], shown["is_there"]) == (model.sha256, True)


def test_a_moved_folder_works(book: Logbook) -> None:
    moved = Logbook(Path(shutil.move(book.folder, book.folder.with_name("elsewhere"))))
    assert [each.month for each in moved.records()] == ["2026-03"]
    status, out, _ = log(moved, "check", "elsewhere")
    assert (status, out) == (0, "elsewhere: 1 entries, all whole\n")


def test_an_entry_without_its_file_is_named_kept_and_comes_back(book: Logbook) -> None:
    (entry,) = book.entries()
    book.path_of(entry).unlink()
    with pytest.raises(InputError, match=r"missing \(monday.parquet, 2026-03-01\): hexdbb log check"):
        book.records()
    status, out, _ = log(book, "check", "glider")
    assert (status, book.entries()) == (1, [entry])
    assert out.startswith(f"LEFT: {entry.place}: missing (monday.parquet, {DATE})")
    assert "its missing file is back" in log(book, "add", "glider", "monday.parquet")[1]
    assert log(book, "check", "glider")[0] == 0


@pytest.mark.parametrize("index_is", ["missing", "damaged"])
def test_files_without_an_index_are_named_and_entered(book: Logbook, index_is: str) -> None:
    if index_is == "missing":
        book.index.path.unlink()
        with pytest.raises(InputError, match=r"not in the index \(1 such\): hexdbb log check"):
            book.records()
    else:
        book.index.path.write_bytes(b"x" * 4096)
        with pytest.raises(InputError, match="damaged: file is not a database"):
            book.records()
    status, out, _ = log(book, "check", "glider")
    assert status == 0
    assert "not in the index: entered" in out
    assert len(book.records()) == 1


def test_a_damaged_file_is_named_and_stays(book: Logbook) -> None:
    (entry,) = book.entries()
    path = book.path_of(entry)
    path.write_bytes(path.read_bytes()[:-100])
    status, out, _ = log(book, "check", "glider")
    assert status == 1
    assert out.startswith("LEFT: ")
    assert path.name in out
    assert path.exists()


def test_what_an_interrupted_copy_left_is_removed(book: Logbook) -> None:
    left = book.folder / "records" / ".abc.parquet.17.part"
    left.write_bytes(b"half")
    assert "left by an interrupted copy: removed" in log(book, "check", "glider")[1]
    assert not left.exists()


def test_an_entry_that_cannot_be_written_leaves_nothing(book: Logbook, record: Record, disk_full_after: object) -> None:
    other = book.folder.parent / "tuesday.parquet"
    changed = {**record.columns, "reading_um": record.columns["reading_um"] + 1.0}
    write_record(replace(record, columns=changed, metadata={"started": DATE}), other)
    with disk_full_after(2000), pytest.raises(RunError, match=r"disk I/O error|cannot be written"):  # type: ignore[operator]
        book.add(other)
    assert len(list((book.folder / "records").iterdir())) == len(book.entries()) == 1


def test_a_logbook_held_by_another_process_is_said_in_one_line(
    book: Logbook, parquet: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(index, "WAIT_S", 0.05)
    other = sqlite3.connect(book.index.path, isolation_level=None)
    other.execute("begin exclusive")
    try:
        status, _, err = log(book, "add", "glider", parquet.name)
    finally:
        other.close()
    assert status == 1
    assert err.splitlines()[-1].startswith("error: glider: in use by another process for more than 0.05 s")
    assert log(book, "add", "glider", parquet.name)[0] == 0


def test_another_machine_is_refused_with_both_names(book: Logbook, record: Record) -> None:
    other = book.folder.parent / "other.parquet"
    machine = record.machine.model_copy(update={"name": "the other glider"})
    write_record(replace(record, machine=machine, metadata={"started": DATE}), other)
    status, _, err = log(book, "add", "glider", "other.parquet")
    assert status == 2
    assert "other.parquet: of the other glider (expected SP-120 (assumed dimensions), whose logbook glider is)" in err
    platform = record.machine.platform.model_copy(update={"moved_mass_kg": 13.0})
    write_record(
        replace(record, machine=record.machine.model_copy(update={"platform": platform}), metadata={"started": DATE}),
        other,
        overwrite=True,
    )
    assert "other.parquet: platform.moved_mass_kg: 13" in log(book, "add", "glider", "other.parquet")[2]
    assert len(book.entries()) == 1


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        ("note.md", "hello", "nothing that a logbook keeps"),
        ("note.txt", "hello", "which circle was driven is not stated (expected --plan PLAN"),
        ("note.parquet", "hello", "not a whole Parquet file"),
        ("note.json", "[1]", "expected what a command printed with --json"),
        ("note.json", "{", "not valid JSON"),
        ("note.toml", 'schema = "hexdbb.plan/1"', 'expected "hexdbb.model/'),
    ],
)
def test_a_file_that_is_none_of_them_is_refused(book: Logbook, name: str, text: str, expected: str) -> None:
    (book.folder.parent / name).write_text(text)
    status, _, err = log(book, "add", "glider", name)
    assert status == 2
    assert name in err
    assert expected in err
    assert len(err.splitlines()) == 1


def test_a_folder_of_something_else_is_no_logbook(book: Logbook) -> None:
    folder = book.folder.parent
    assert "holds other files" in log(book, "add", folder, "monday.parquet")[2]
    assert "no logbook (expected a folder with machine.toml and logbook.sqlite)" in log(book, "list", folder)[2]
    assert "no such logbook" in log(book, "list", "nowhere")[2]
    other = sqlite3.connect(folder / "other.sqlite")
    other.execute("create table t (x)")
    other.close()
    (folder / "other.sqlite").replace(book.index.path)
    assert "a database of something else" in log(book, "list", "glider")[2]


def test_a_run_files_its_record_and_refuses_another_machines_logbook_before(book: Logbook, record: Record) -> None:
    path = book.folder.parent / "run.parquet"
    new = replace(record, columns={**record.columns, "reading_um": -record.columns["reading_um"]})
    write_record(replace(new, metadata={"started": DATE}), path)
    said = filing_in(book.folder, record.machine)(read_record(path))
    assert said.startswith(f"filed in {book.folder}: record ")
    assert len(book.entries()) == 2
    (book.folder / "machine.toml").write_text(dump_toml(record.machine.model_copy(update={"name": "another"})))
    with pytest.raises(InputError, match=r"of SP-120 .* \(expected another, whose logbook"):
        filing_in(book.folder, record.machine)
