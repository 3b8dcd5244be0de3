"""A record with the time at which it was measured."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime

from hexdbb.errors import InputError
from hexdbb.record import Record

STARTED = "started"
"""Key of a record's metadata: date, or date and time, of the first sample."""


@dataclass(frozen=True, eq=False)
class Dated:
    """A record and when it began, UTC."""

    record: Record
    measured: datetime

    @property
    def month(self) -> str:
        """Year and month: ``2026-03``."""
        return self.measured.strftime("%Y-%m")


def dated(record: Record) -> Dated:
    """Return a record with the time that its metadata state.

    Raises
    ------
    InputError
        They state none, or what is no date.
    """
    stated = record.metadata.get(STARTED)
    if stated is None:
        raise InputError(f"{record.name}: {STARTED}: missing (expected the date of its first sample: --date)")
    return Dated(record, parsed_time(str(stated), f"{record.name}: {STARTED}"))


def parsed_time(text: str, where: str) -> datetime:
    """Return a date, or date and time, in ISO 8601 as UTC; without a zone it counts as UTC; `InputError` otherwise."""
    try:
        found = datetime.fromisoformat(text)
    except ValueError:
        raise InputError(f'{where}: "{text}" (expected a date such as 2026-03-01 or 2026-03-01T08:30)') from None
    return found.astimezone(UTC) if found.tzinfo is not None else found.replace(tzinfo=UTC)
