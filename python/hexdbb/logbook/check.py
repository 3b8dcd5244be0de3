"""Checking a logbook: files without an entry, entries without a file, files that are not what their name says.

What can be repaired is: a whole file that the index does not name is entered, an index that is missing or damaged is
made anew from the files, what an interrupted copy left is removed. Nothing else is removed or changed: an entry whose
file is missing stays, so that the file can be brought back, and a damaged file stays for `hexdbb recover`.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from hexdbb.errors import InputError
from hexdbb.logbook.folder import SHORT, Logbook, entry_of, files_of
from hexdbb.logbook.index import Entry, all_entries, insert
from hexdbb.logbook.kinds import Content, content_of
from hexdbb.trend import parsed_time


@dataclass(frozen=True)
class Finding:
    """One thing that was wrong.

    Attributes
    ----------
    what : str
        A sentence naming the file.
    repaired : bool
    """

    what: str
    repaired: bool


def check(logbook: Logbook, progress: Callable[[str], None] = lambda _: None) -> list[Finding]:
    """Check a logbook and repair what can be repaired; every file is read.

    Parameters
    ----------
    logbook : Logbook
    progress : callable
        Told which file is read.

    Raises
    ------
    RunError
        Another process holds the logbook.
    """
    found = list(_set_aside(logbook))
    with logbook.index.writing() as connection:
        known = all_entries(connection)
        found += _of_entries(logbook, known, progress)
        found += _of_files(logbook, connection, {each.place for each in known}, progress)
    return found


def _set_aside(logbook: Logbook) -> Iterator[Finding]:
    """Set a damaged index aside, so that a new one is made."""
    path = logbook.index.path
    if not path.exists():
        yield Finding(f"{path}: missing: made anew from the files; names and times of adding are lost", True)
        return
    try:
        logbook.index.entries()
    except InputError as error:
        number = 1
        while (aside := path.with_name(f"{path.name}.damaged-{number}")).exists():
            number += 1
        path.replace(aside)
        yield Finding(f"{error}: kept as {aside.name}, made anew from the files", True)


def _of_entries(logbook: Logbook, known: list[Entry], progress: Callable[[str], None]) -> Iterator[Finding]:
    for entry in known:
        path = logbook.path_of(entry)
        progress(entry.name)
        if not path.is_file():
            yield Finding(
                f"{entry.place}: missing ({entry.name}, {entry.measured[:10]}): bring the file back, or add it again",
                False,
            )
            continue
        content, why = _content(logbook, path)
        if content is None:
            yield Finding(why, False)
        elif content.sha256 != entry.sha256:
            yield Finding(f"{entry.place}: holds another content than its name says, {content.sha256}", False)


def _of_files(
    logbook: Logbook, connection: sqlite3.Connection, places: set[str], progress: Callable[[str], None]
) -> Iterator[Finding]:
    for path in files_of(logbook.folder):
        place = path.relative_to(logbook.folder).as_posix()
        if place in places:
            continue
        if path.name.startswith(".") and path.suffix == ".part":
            path.unlink()  # nobody else writes while the index is held
            yield Finding(f"{place}: left by an interrupted copy: removed", True)
            continue
        progress(path.name)
        content, why = _content(logbook, path)
        if content is None:
            yield Finding(f"{why}: no entry", False)
        elif content.place != place:
            yield Finding(f"{place}: no entry, and not named by its content (expected: hexdbb log add it)", False)
        else:
            changed = datetime.fromtimestamp(path.stat().st_mtime, UTC)
            measured = changed if content.measured is None else parsed_time(content.measured, str(path))
            insert(connection, entry_of(content, f"{content.sha256[:SHORT]}{path.suffix}", measured, changed))
            yield Finding(f"{place}: not in the index: entered", True)


def _content(logbook: Logbook, path: Path) -> tuple[Content | None, str]:
    """Return what a file holds, or why it cannot be said."""
    try:
        content = content_of(path, logbook.machine)
        if content.machine is not None:
            logbook.require(content.machine, str(path))
    except InputError as error:
        return None, str(error)
    return content, ""
