"""Files written whole or not at all: to a temporary file in the same directory, synchronised, then renamed (POSIX)."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hexdbb.errors import InputError, RunError


def refuse_existing(path: Path, overwrite: bool) -> None:
    """Check that a file may be written: it does not exist or may be overwritten, and its directory exists.

    Raises
    ------
    InputError
        It may not; names the file.
    """
    if not path.parent.is_dir():
        raise InputError(f"{path}: no such directory {path.parent} (expected one that exists)")
    if path.is_dir():
        raise InputError(f"{path}: is a directory (expected the name of a file)")
    if path.exists() and not overwrite:
        raise InputError(f"{path}: exists already (expected a new name, or the overwrite option)")


def require_folder(folder: Path) -> None:
    """Check that a folder is there, or can be made: the one it stands in exists.

    Raises
    ------
    InputError
        It stands in none, or is a file.
    """
    if not folder.parent.is_dir():
        raise InputError(f"{folder}: no such directory {folder.parent} (expected one that exists)")
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder}: is a file (expected the name of a folder)")


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a temporary path to write to; it replaces `path` when the block ends without an error.

    Parameters
    ----------
    path : Path
        The file to be written; an existing one is untouched until the new one is whole and on disk.

    Raises
    ------
    RunError
        The file cannot be written (permissions, disk full); the temporary file is removed.
    """
    temporary = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        yield temporary
        with temporary.open("rb+") as file:
            os.fsync(file.fileno())
        temporary.replace(path)
        sync_directory(path.parent)
    except OSError as error:
        raise RunError(f"{path}: cannot be written: {error.strerror or error}") from error
    finally:
        temporary.unlink(missing_ok=True)


def sync_directory(directory: Path) -> None:
    """Synchronise a directory (fsync), so that files created or renamed in it survive a power loss."""
    descriptor = os.open(directory, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def write_text(path: Path, text: str) -> None:
    """Write a UTF-8 text file whole or not at all, replacing an existing one; line ends stay as given.

    Raises
    ------
    RunError
        The file cannot be written.
    """
    with replacing(path) as temporary:
        temporary.write_bytes(text.encode())
