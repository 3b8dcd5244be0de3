"""Names by which the records of a table are told apart in tables, sentences and pictures."""

from __future__ import annotations

from collections.abc import Sequence

from hexdbb.record import Record


def record_names(records: Sequence[Record]) -> list[str]:
    """Return the name of each record's file, or the whole path where two files have the same name."""
    paths = [record.path for record in records]
    short = ["record" if path is None else path.name for path in paths]
    if len(set(short)) == len(short):
        return short
    return [f"record {number}" if path is None else str(path) for number, path in enumerate(paths, start=1)]
