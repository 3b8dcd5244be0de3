"""What `hexdbb log list --json` and `hexdbb log show --json` print."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from hexdbb.files.results import JsonPart, JsonResult
from hexdbb.logbook.folder import Logbook
from hexdbb.logbook.index import Entry


@dataclass(frozen=True)
class LogEntryJson(JsonPart):
    """One entry of a logbook."""

    kind: str
    """`record`, `model`, `verdict` or `compensation`."""
    sha256: str
    """Hash of its content."""
    name: str
    """Name of the file that was added."""
    path: str
    """Where its file lies."""
    measured: str
    """When it was measured or made, ISO 8601, UTC."""
    added: str
    """When it was added, ISO 8601, UTC."""
    is_there: bool
    """Whether its file is there."""
    facts: dict[str, Any]
    """What lists show of it, by kind."""


@dataclass(frozen=True)
class LogJson(JsonResult):
    """Entries of a logbook: all of them, those of one kind, or the one shown."""

    SCHEMA = "hexdbb.log/1"

    machine: str
    """Name of the machine."""
    entries: tuple[LogEntryJson, ...]
    """In the order of their times."""


def log_json(logbook: Logbook, entries: Sequence[Entry]) -> LogJson:
    """Return entries as the command prints them."""
    return LogJson(logbook.machine.name, tuple(LogEntryJson(**_fields(logbook, each)) for each in entries))


def _fields(logbook: Logbook, entry: Entry) -> dict[str, Any]:
    path = logbook.path_of(entry)
    return {
        "kind": entry.kind,
        "sha256": entry.sha256,
        "name": entry.name,
        "path": str(path),
        "measured": entry.measured,
        "added": entry.added,
        "is_there": path.is_file(),
        "facts": entry.facts,
    }
