"""The index of a logbook: one table in SQLite, written in transactions; other processes wait their turn.

The index holds nothing that the files do not say, but when they were added and under which name: it can be made anew
from them (`hexdbb.logbook.check`).
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hexdbb.errors import InputError, RunError

NAME = "logbook.sqlite"
WAIT_S = 5.0
"""Longest time for another process to finish: adding a record of an hour takes two seconds."""
APPLICATION = 0x48585642
"""SQLite's application id of a logbook ("HXVB"), so that no other database is taken for one."""
TABLE = """create table if not exists entry (
    kind text not null, sha256 text not null, place text not null, name text not null,
    measured text not null, added text not null, facts text not null,
    primary key (kind, sha256))"""


@dataclass(frozen=True)
class Entry:
    """One entry of a logbook.

    Attributes
    ----------
    kind, sha256 : str
    place : str
        Path of its file, relative to the logbook.
    name : str
        Of the file that was added.
    measured, added : str
        Times, ISO 8601, UTC; of what is not a record, `measured` is when its file was last changed or what was stated.
    facts : dict
        What lists show.
    """

    kind: str
    sha256: str
    place: str
    name: str
    measured: str
    added: str
    facts: dict[str, Any]


class Index:
    """The index of the logbook in a folder.

    Raises
    ------
    InputError
        Of every function: the file is no index of a logbook.
    RunError
        Of every function: another process holds it for too long, or it cannot be written.
    """

    def __init__(self, folder: Path) -> None:
        self.path = folder / NAME

    @contextmanager
    def writing(self) -> Iterator[sqlite3.Connection]:
        """Hold the index alone; what is done in the block counts when it ends without an error, else nothing of it."""
        with self._connected() as connection:
            connection.execute("begin immediate")
            try:
                connection.execute(TABLE)
                connection.execute(f"pragma application_id = {APPLICATION}")
                yield connection
                connection.execute("commit")
            except BaseException:
                if connection.in_transaction:
                    connection.execute("rollback")
                raise

    def entries(self) -> list[Entry]:
        """Return all entries, in the order of their times."""
        if not self.path.exists():
            return []
        with self._connected() as connection:
            return all_entries(connection)

    @contextmanager
    def _connected(self) -> Iterator[sqlite3.Connection]:
        connection = None
        try:
            connection = sqlite3.connect(self.path, timeout=WAIT_S, isolation_level=None)
            (application,) = connection.execute("pragma application_id").fetchone()
            (tables,) = connection.execute("select count(*) from sqlite_master").fetchone()
            if tables and application != APPLICATION:
                raise InputError(f"{self.path}: a database of something else (expected the index of a logbook)")
            yield connection
        except sqlite3.OperationalError as error:
            if "locked" in str(error) or "busy" in str(error):
                raise RunError(
                    f"{self.path.parent}: in use by another process for more than {WAIT_S:g} s"
                    " (expected its end: try again then)"
                ) from None
            raise RunError(f"{self.path}: {error}") from None
        except sqlite3.DatabaseError as error:
            raise InputError(f"{self.path}: damaged: {error} (expected: hexdbb log check makes it anew)") from None
        finally:
            if connection is not None:
                connection.close()


def all_entries(connection: sqlite3.Connection) -> list[Entry]:
    """Return all entries, in the order of their times."""
    (there,) = connection.execute("select count(*) from sqlite_master where name = 'entry'").fetchone()
    if not there:
        return []
    rows = connection.execute(
        "select kind, sha256, place, name, measured, added, facts from entry order by measured, added, sha256"
    )
    return [
        Entry(kind, sha256, place, name, measured, added, json.loads(facts))
        for kind, sha256, place, name, measured, added, facts in rows
    ]


def insert(connection: sqlite3.Connection, entry: Entry) -> None:
    """Add an entry that is not there yet."""
    connection.execute(
        "insert into entry (kind, sha256, place, name, measured, added, facts) values (?, ?, ?, ?, ?, ?, ?)",
        (entry.kind, entry.sha256, entry.place, entry.name, entry.measured, entry.added, json.dumps(entry.facts)),
    )
