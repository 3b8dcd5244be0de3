"""A logbook: one folder for one machine, with all its records, models, verdicts and compensation files.

::

    FOLDER/machine.toml            the machine, with the limits of its trend: edit them here
    FOLDER/logbook.sqlite          the index
    FOLDER/records/SHA256.parquet  and models, verdicts, compensations alike

Files are named by their content and never changed; paths in the index are relative, so a folder may be moved or copied.
A file is written whole before the index names it, both while the index is held: whatever ends the program, either the
entry is there with its file, or a file waits for `check` to enter it.
"""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from hexdbb.errors import InputError
from hexdbb.files.atomic_file import write_text
from hexdbb.files.validation import dump_toml
from hexdbb.logbook.index import NAME, Entry, Index, all_entries, insert
from hexdbb.logbook.kinds import FOLDERS, Content, content_of
from hexdbb.machine import MachineFile, load_machine
from hexdbb.record import read_record, require_dimensions
from hexdbb.trend import Dated, dated, parsed_time

MACHINE = "machine.toml"
SHORT = 12
"""Characters of a hash in lists: two of a million entries share them with a probability of one in 500."""


@dataclass(frozen=True)
class Added:
    """What became of a file: its entry, whether that is new, and whether a missing file of an old one is back."""

    entry: Entry
    is_new: bool
    is_back: bool = False


class Logbook:
    """The logbook in a folder.

    Parameters
    ----------
    folder : Path
        That of a logbook.

    Raises
    ------
    InputError
        The folder is none of a logbook.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.index = Index(folder)
        if not folder.is_dir():
            raise InputError(
                f"{folder}: no such logbook (expected a folder, as `hexdbb log add {folder} RECORD` makes)"
            )
        if not (folder / MACHINE).is_file():
            there = "its machine.toml is missing" if self.index.path.exists() else "no logbook"
            raise InputError(f"{folder}: {there} (expected a folder with {MACHINE} and {NAME})")
        self.machine = load_machine(folder / MACHINE)

    @classmethod
    def of(cls, folder: Path, machine: MachineFile) -> Logbook:
        """Return the logbook in a folder; a new one of a machine where the folder is empty or not there yet.

        Raises
        ------
        InputError
            The folder holds something else, or cannot be made.
        """
        if not (folder / MACHINE).exists() and not (folder / NAME).exists():
            if folder.exists() and not folder.is_dir():
                raise InputError(f"{folder}: is a file (expected the name of a folder)")
            if not folder.parent.is_dir():
                raise InputError(f"{folder}: no such directory {folder.parent} (expected one that exists)")
            if folder.is_dir() and any(not each.name.startswith(".") for each in folder.iterdir()):
                raise InputError(f"{folder}: holds other files (expected a logbook, an empty folder or a new name)")
            folder.mkdir(exist_ok=True)
            write_text(folder / MACHINE, dump_toml(machine))
        return cls(folder)

    def entries(self, kind: str | None = None) -> list[Entry]:
        """Return its entries, or those of one kind, in the order of their times."""
        return [each for each in self.index.entries() if kind in (None, each.kind)]

    def entry(self, text: str) -> Entry:
        """Return the entry whose hash begins so, or whose file had that name.

        Raises
        ------
        InputError
            There is none, or more than one.
        """
        found = [each for each in self.entries() if each.sha256.startswith(text) or each.name == text]
        if len(found) != 1:
            what = "no such entry" if not found else f"{len(found)} entries"
            raise InputError(f"{self.folder}: {text}: {what} (expected the beginning of one hash: hexdbb log list)")
        return found[0]

    def path_of(self, entry: Entry) -> Path:
        """Return where an entry's file lies."""
        return self.folder / entry.place

    def require(self, machine: MachineFile, origin: str) -> None:
        """Check that a file is of this logbook's machine: name, serial number where both state one, dimensions.

        Raises
        ------
        InputError
            It is not; with both names.
        """
        own = self.machine
        serials = (own.serial_number, machine.serial_number)
        differ = None not in serials and serials[0] != serials[1]
        if machine.name != own.name or differ:
            raise InputError(f"{origin}: of {_named(machine)} (expected {_named(own)}, whose logbook {self.folder} is)")
        require_dimensions(own, str(self.folder / MACHINE), machine, origin)

    def add(self, path: Path, date: str | None = None) -> Added:
        """Add a file; one whose content is there already is left as it is.

        Parameters
        ----------
        path : Path
        date : str, optional
            When it was measured or made, where the file does not say; ISO 8601.

        Raises
        ------
        InputError
            The file is none of what a logbook keeps, is of another machine, or says no time and none is given.
        RunError
            The logbook is in use by another process, or cannot be written.
        """
        return self.add_content(content_of(path, self.machine), date)

    def add_content(self, content: Content, date: str | None = None) -> Added:
        """Add a file that has been read; see `add`."""
        if content.machine is not None:
            self.require(content.machine, str(content.path))
        content, measured = self._timed(content, date)
        with self.index.writing() as connection:
            known = _known(connection, content)
            target = self.folder / content.place
            is_back = known is not None and not target.exists()
            if known is None or is_back:
                target.parent.mkdir(exist_ok=True)
                content.write(target)
                os.utime(target, (measured.timestamp(), measured.timestamp()))
            if known is not None:
                return Added(known, is_new=False, is_back=is_back)
            entry = entry_of(content, content.path.name, measured, datetime.now(UTC))
            insert(connection, entry)
            return Added(entry, is_new=True)

    def records(self) -> list[Dated]:
        """Return the complete records, in the order of their times.

        Raises
        ------
        InputError
            A file is missing or damaged, or lies there without an entry.
        """
        found = []
        loose = [each for each in self.loose() if each.parent.name == FOLDERS["record"]]
        if loose:
            raise InputError(f"{loose[0]}: not in the index ({len(loose)} such): hexdbb log check {self.folder}")
        for entry in self.entries("record"):
            path = self.path_of(entry)
            if not path.is_file():
                raise InputError(
                    f"{path}: missing ({entry.name}, {entry.measured[:10]}): hexdbb log check {self.folder}"
                )
            if entry.facts.get("complete", True):
                found.append(dated(read_record(path)))
        return sorted(found, key=lambda each: each.measured)

    def loose(self) -> list[Path]:
        """Return the files that no entry names."""
        named = {each.place for each in self.entries()}
        return [each for each in files_of(self.folder) if each.relative_to(self.folder).as_posix() not in named]

    def _timed(self, content: Content, date: str | None) -> tuple[Content, datetime]:
        """Return a content and its time: what the file states, else what is given, else when it was changed last."""
        given = None if date is None else parsed_time(date, "--date")
        if content.measured is not None:
            return content, parsed_time(content.measured, f"{content.path}: started")
        if given is not None:
            return content.measured_at(given.isoformat()), given
        if content.kind == "record":
            raise InputError(f"{content.path}: does not say when it was measured (expected --date 2026-03-01)")
        return content, datetime.fromtimestamp(int(content.path.stat().st_mtime), UTC)


def files_of(folder: Path) -> Iterator[Path]:
    """Yield all files in the folders of entries, sorted."""
    for name in FOLDERS.values():
        if (folder / name).is_dir():
            yield from sorted(each for each in (folder / name).iterdir() if each.is_file())


def entry_of(content: Content, name: str, measured: datetime, added: datetime) -> Entry:
    """Return the entry of a content."""
    return Entry(
        content.kind,
        content.sha256,
        content.place,
        name,
        measured.astimezone(UTC).isoformat(timespec="seconds"),
        added.isoformat(timespec="seconds"),
        content.facts,
    )


def _known(connection: sqlite3.Connection, content: Content) -> Entry | None:
    mine = (content.kind, content.sha256)
    return next((each for each in all_entries(connection) if (each.kind, each.sha256) == mine), None)


def _named(machine: MachineFile) -> str:
    serial = "" if machine.serial_number is None else f", serial number {machine.serial_number}"
    return f"{machine.name}{serial}"
