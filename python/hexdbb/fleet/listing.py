"""Records at URLs as tasks: files, folders and patterns in any store, each content once.

The key of a task is made of the content of a record's files, the model and the command: a file that is moved or listed
twice is not judged again, one that has changed is. A local file is read for it; of a store its checksum serves (ETag).
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any

from hexdbb.cluster import Storage, Task, content_key, storage_of
from hexdbb.errors import InputError
from hexdbb.fleet.columns import UNKNOWN
from hexdbb.record.formats import FORMATS

WILDCARDS = "*?["
READERS = 8
"""Files read at a time for their hashes: a disk and a core are busy with fewer."""
COMPANIONS = {".csv": (".toml", ".machine.toml")}
"""Files beside a record that it is made of, by its suffix."""


@dataclass(frozen=True)
class Listing:
    """Records found.

    Attributes
    ----------
    tasks : tuple of Task
        One a content, by the names of the files.
    copies : tuple of (str, str)
        Files that have the content of another, which is named second.
    """

    tasks: tuple[Task, ...]
    copies: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class _Found:
    """A record's file, and what there is beside it."""

    storage: Storage
    path: str
    details: dict[str, Any]
    companions: tuple[tuple[str, dict[str, Any]], ...]

    @property
    def source(self) -> str:
        return self.storage.named(self.path)

    def content(self) -> str:
        """Return the hash of its content, and of that of its companions."""
        beside = [[PurePosixPath(path).suffixes, self._hash(path, each)] for path, each in self.companions]
        return content_key(self._hash(self.path, self.details), beside)

    def _hash(self, path: str, details: dict[str, Any]) -> str:
        if self.storage.is_local:
            with self.storage.refusals("cannot be read", path), Path(path).open("rb") as file:
                return hashlib.file_digest(file, "sha256").hexdigest()
        stated = details.get("ETag") or details.get("etag") or details.get("md5Hash")
        return f"{stated}/{details.get('size')}" if stated else str(self.storage.system.ukey(path))


def list_records(urls: Iterable[str], command: str, model: str | None = None, *, leave_out: str = "") -> Listing:
    """Find the records at some URLs.

    Parameters
    ----------
    urls : iterable of str
        Files; folders, of which every file with the suffix of a record counts; patterns with ``*``, ``?``, ``**``.
    command : str
        ``diagnose`` or ``discover``.
    model : str, optional
        Text of a model file or machine file.
    leave_out : str
        A URL of which nothing counts: where results are written.

    Raises
    ------
    InputError
        A URL at which there is no record.
    RunError
        A store refuses or does not answer.
    """
    found: dict[str, _Found] = {}
    for url in urls:
        here = {each.source: each for each in _at(url, leave_out)}
        if not here:
            raise InputError(f"{url}: no record there (expected files {', '.join(FORMATS)}, or a pattern for them)")
        found |= here
    ordered = [found[source] for source in sorted(found)]
    with ThreadPoolExecutor(READERS) as readers:
        contents = list(readers.map(_Found.content, ordered))
    of_model = None if model is None else hashlib.sha256(model.encode()).hexdigest()
    tasks: dict[str, Task] = {}
    copies = []
    for each, content in zip(ordered, contents, strict=True):
        key = content_key("fleet", content, command, of_model)
        if key in tasks:
            copies.append((each.source, str(tasks[key].labels["source"])))
            continue
        files = [each.path, *(path for path, _ in each.companions)]
        payload = {"source": each.source, "files": files, "command": command, "model": model}
        labels = {"source": each.source, "command": command, "machine": UNKNOWN, "month": UNKNOWN}
        tasks[key] = Task(key, payload, labels)
    return Listing(tuple(tasks.values()), tuple(copies))


def _at(url: str, leave_out: str) -> Iterator[_Found]:
    """Yield the records at a URL."""
    storage = storage_of(url)
    is_pattern = any(mark in storage.root for mark in WILDCARDS)
    with storage.refusals("cannot be listed"):
        storage.system.invalidate_cache()
        if is_pattern:
            files = storage.system.glob(storage.root, detail=True)
        else:
            files = storage.system.find(storage.root, detail=True)
    excluded = storage_of(leave_out).root.rstrip("/") + "/" if leave_out else None
    files = {path: each for path, each in files.items() if each["type"] != "directory"}
    single = not is_pattern and list(files) == [storage.root]
    for path, details in files.items():
        if excluded is not None and path.startswith(excluded):
            continue
        suffix = PurePosixPath(path).suffix
        if suffix in FORMATS or single:
            yield _Found(storage, path, details, tuple(_companions(storage, files, path, suffix)))


def _companions(
    storage: Storage, files: dict[str, Any], path: str, suffix: str
) -> Sequence[tuple[str, dict[str, Any]]]:
    """Return the files beside a record that it is made of, as far as they are there."""
    found = []
    for other in COMPANIONS.get(suffix, ()):
        beside = path.removesuffix(suffix) + other
        details = files.get(beside)
        if details is None:  # a pattern may name the readings only
            with storage.refusals("cannot be listed", beside):
                details = storage.system.info(beside) if storage.system.exists(beside) else None
        if details is not None:
            found.append((beside, details))
    return found
