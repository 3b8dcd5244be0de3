"""Journals that an interrupted capture has left where a new one begins: refused or set aside, never deleted."""

from __future__ import annotations

import fcntl
from pathlib import Path

from hexdbb.errors import InputError
from hexdbb.record.recovery import read_journal


def make_way(journal: Path, overwrite: bool) -> Path | None:
    """Make way for a new journal.

    Parameters
    ----------
    journal : Path
        Where the new journal begins; an empty file there was left before its first samples, and may stay.
    overwrite : bool
        Whether a journal with samples may be set aside.

    Returns
    -------
    Path or None
        Where the old journal is kept now: with a number after its name. None if there was none, or an empty one.

    Raises
    ------
    InputError
        There is a journal with samples that may not be set aside, or a running capture is writing it.
    """
    if not journal.exists() or journal.stat().st_size == 0:
        return None
    try:
        with journal.open("rb") as file:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        raise InputError(f"{journal}: in use by a running capture (expected another record name)") from None
    except OSError as error:
        raise InputError(f"{journal}: cannot be read: {error.strerror} (expected none)") from None
    if not overwrite and _holds_samples(journal):
        expected = f"none; make a record of it with: hexdbb recover {journal}"
        raise InputError(f"{journal}: left by an interrupted capture (expected {expected})")
    kept = _free_name(journal)
    journal.rename(kept)
    return kept


def _holds_samples(journal: Path) -> bool:
    try:
        return len(read_journal(journal, complete=False, reason=None)[0]) > 0
    except InputError:
        return False


def _free_name(journal: Path) -> Path:
    number = 1
    while (kept := journal.with_name(f"{journal.name}.{number}")).exists():
        number += 1
    return kept
