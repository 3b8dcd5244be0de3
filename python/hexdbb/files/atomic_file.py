"""Files that are there whole or not at all: written beside their place, synchronised, then renamed over it (POSIX)."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hexdbb.errors import InputError, RunError


def refuse_existing(path: Path, overwrite: bool) -> None:
    """Refuse to write where something stands, unless told to, or where there is no directory.

    Raises
    ------
    InputError
        Naming the file.
    """
    if not path.parent.is_dir():
        raise InputError(f"{path}: no such directory {path.parent} (expected one that exists)")
    if path.is_dir():
        raise InputError(f"{path}: is a directory (expected the name of a file)")
    if path.exists() and not overwrite:
        raise InputError(f"{path}: exists already (expected a new name, or to be told to overwrite)")


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give a temporary path to write to, which takes the place of `path` when the block ends well.

    Parameters
    ----------
    path : Path
        Final place; what stands there stays untouched until the new file is whole and on disk.

    Raises
    ------
    RunError
        Where the file cannot be written (permissions, disk full); nothing is left behind.
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
    """Make what was created or renamed in a directory survive a power loss."""
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
