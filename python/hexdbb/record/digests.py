"""Digests that a record carries of its own content, so that any later change of a bit is detected.

Form: the first 64 bits of SHA-256 (FIPS 180-4), as 16 hexadecimal digits; of a column its name, type and values count.
A digest covers what is read, not how it is stored: values, names and metadata, whatever compression lies between.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ValidationError

from hexdbb.errors import InputError
from hexdbb.record.columns import Columns

OWN_KEYS, DIGESTS_KEY = "hexdbb", "hexdbb.digests"
"""First letters of the metadata keys of a record; the key of the digests among them."""

DIGITS = 16
"""Hexadecimal digits of a digest. 64 bits: damage passes once in 2^64 cases, and a record of an hour has 4,000 digests,
in 80 kB; the full 256 bits would only make the file larger."""
PLAIN_KINDS = "biuf"
"""NumPy kinds whose bytes are their values: booleans, integers, floats. Others (text, dates) count by their `repr`,
because a file may store them with another width or time unit."""


def digest(*parts: bytes | memoryview) -> str:
    """Return the digest of parts of bytes; the length of each part in bytes counts."""
    *first, last = parts
    before = b"".join(each for part in first for each in (_length(part), part))
    sha256 = hashlib.sha256(before + _length(last))
    sha256.update(last)
    return sha256.hexdigest()[:DIGITS]


def _length(part: bytes | memoryview) -> bytes:
    return memoryview(part).nbytes.to_bytes(8, "little")


def column_digest(name: str, values: NDArray[Any]) -> str:
    """Return the digest of a column's name, type and values, shape (n,)."""
    plain = values.dtype.kind in PLAIN_KINDS
    kind = values.dtype.newbyteorder("<")
    content = np.ascontiguousarray(values, kind).data if plain else repr(values.tolist()).encode(errors="replace")
    return digest(name.encode(errors="replace"), (kind.str if plain else "other").encode(), content)


def differing(stated: Mapping[str, str], found: Mapping[str, str]) -> list[str]:
    """Return the names whose digests differ, or that only one of the two has, in the order of `stated`."""
    return [name for name in {**stated, **found} if stated.get(name) != found.get(name)]


class Digests(BaseModel):
    """JSON under the metadata key `hexdbb.digests`."""

    rows_per_group: int
    metadata: dict[str, str]
    """Digest of each metadata entry of a record, by key."""
    columns: dict[str, list[str]]
    """Digest of each column, one per row group, by name."""

    def damaged_metadata(self, metadata: Mapping[str, bytes]) -> list[str]:
        """Return the keys of entries that are not as they were written."""
        return differing(self.metadata, _metadata_digests(metadata))

    def damaged_parts(self, columns: Columns) -> Iterator[tuple[str, int]]:
        """Yield column and row group (from 0) of all that is not as it was written."""
        found = _column_digests(columns, self.rows_per_group)
        for name in {**self.columns, **found}:
            stated, own = self.columns.get(name, []), found.get(name, [])
            for group in range(max(len(stated), len(own))):
                if stated[group : group + 1] != own[group : group + 1]:
                    yield name, group


def digests_of(columns: Columns, metadata: Mapping[str, bytes], rows_per_group: int) -> Digests:
    """Return the digests of a record's columns and metadata."""
    found = _column_digests(columns, rows_per_group)
    return Digests(rows_per_group=rows_per_group, metadata=_metadata_digests(metadata), columns=found)


def stated_digests(metadata: Mapping[str, bytes], path: Path) -> Digests | None:
    """Return the digests that a file states; None where it states none.

    Raises
    ------
    InputError
        They are damaged.
    """
    if DIGESTS_KEY not in metadata:
        return None
    try:
        return Digests.model_validate_json(metadata[DIGESTS_KEY])
    except ValidationError:
        raise InputError(f"{path}: metadata {DIGESTS_KEY}: damaged (expected the digests of a record)") from None


def text_keys(metadata: dict[bytes, bytes] | None) -> dict[str, bytes]:
    """Return metadata by keys that are text."""
    return {key.decode(errors="replace"): value for key, value in (metadata or {}).items()}


def _metadata_digests(metadata: Mapping[str, bytes]) -> dict[str, str]:
    """Return the digest of each metadata entry of a record."""
    return {key: digest(value) for key, value in metadata.items() if key.startswith(OWN_KEYS) and key != DIGESTS_KEY}


def _column_digests(columns: Columns, rows: int) -> dict[str, list[str]]:
    """Return the digests of each column's row groups of `rows` rows."""
    return {
        name: [column_digest(name, values[first : first + rows]) for first in range(0, len(values), rows)]
        for name, values in columns.items()
    }
