"""Bytes of a journal: an Arrow IPC stream whose batches state their own digests.

Each batch carries, as JSON in its metadata under `BATCH_KEY`, the number of its first row, the digest of the stream's
schema (columns, measurement and machine) and one of each of its columns. The first batch carries a copy of the schema
too, found by its mark where the beginning of the file is damaged. Reading passes over what is damaged and goes on with
the next batch that proves itself. Journals of versions before digests are read batch by batch up to the first fault.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import pyarrow as pa
from pydantic import BaseModel, ValidationError

from hexdbb.record.digests import column_digest, differing, digest
from hexdbb.record.tables import batch_columns

BATCH_KEY, SCHEMA_KEY = b"hexdbb.batch", b"hexdbb.schema"
SCHEMA_MARK = b"hexdbb schema, copy: "
"""Precedes the copy of the schema; long enough that samples do not hold it by chance."""
MESSAGE_MARK = b"\xff\xff\xff\xff"
"""First bytes of every message of an Arrow IPC stream (Arrow columnar format, encapsulated message format)."""
ALIGNMENT = 8
"""Every message begins at a multiple of this many bytes (the same source)."""


class BatchHeader(BaseModel, defer_build=True):
    """What a batch states about itself."""

    first_row: int
    schema_digest: str
    """Digest of the stream's schema and of `first_row`."""
    columns: dict[str, str]
    """Digest of each column, by name."""


@dataclass
class Batches:
    """What was read of a journal.

    Attributes
    ----------
    whole : batches whose content is as it was written
    damaged : what is not, in words: rows, and columns where these are known
    rows : rows up to the end of the last whole batch, the damaged ones included
    lost : rows known to be missing
    """

    whole: list[pa.RecordBatch] = field(default_factory=list)
    damaged: list[str] = field(default_factory=list)
    rows: int = 0
    lost: int = 0

    def skip(self, first_row: int, suspects: list[str]) -> None:
        """Note that the rows up to `first_row` are missing; `suspects` names what is known to be damaged."""
        if first_row > self.rows:
            what = f" ({', '.join(suspects)})" if suspects else ""
            self.damaged.append(f"rows {self.rows + 1} to {first_row}{what}")
            self.lost += first_row - self.rows

    def add(self, batch: pa.RecordBatch, first_row: int) -> None:
        """Add a whole batch."""
        self.whole.append(batch)
        self.rows = first_row + batch.num_rows


def write_batch(stream: pa.ipc.RecordBatchStreamWriter, batch: pa.RecordBatch, first_row: int) -> None:
    """Write one batch with its digests; the first one with a copy of the schema."""
    schema = batch.schema.serialize().to_pybytes()
    header = BatchHeader(first_row=first_row, schema_digest=_schema_digest(schema, first_row), columns=_digests(batch))
    metadata = {BATCH_KEY: header.model_dump_json().encode()}
    if first_row == 0:
        metadata[SCHEMA_KEY] = SCHEMA_MARK + len(schema).to_bytes(8, "little") + schema
    stream.write_batch(batch, custom_metadata=metadata)


def read_batches(path: Path) -> Batches:
    """Read every whole batch of a journal."""
    data = path.read_bytes()
    read = Batches()
    for schema in _schemas(data):
        read = _verified(data, schema)
        if read.whole:
            return read
    return _unverified(data) if BATCH_KEY not in data else read


def _schemas(data: bytes) -> Iterator[bytes]:
    """Yield the message that describes the columns: the one that the stream begins with, then its copy."""
    with suppress(pa.ArrowException, OSError, EOFError):
        yield pa.ipc.read_message(pa.BufferReader(data)).serialize().to_pybytes()
    at = data.find(SCHEMA_MARK)
    if at >= 0:
        at += len(SCHEMA_MARK)
        size = int.from_bytes(data[at : at + 8], "little")
        yield data[at + 8 : at + 8 + size]


def _verified(data: bytes, schema: bytes) -> Batches:
    """Return the batches that prove themselves under a schema, and what lies damaged before and between them."""
    read, suspects = Batches(), list[str]()
    reader, at = pa.BufferReader(data), 0
    while 0 <= at < len(data):
        try:
            reader.seek(at)
            batch, header = _batch(pa.ipc.read_message(reader), schema)
        except (pa.ArrowException, OSError, EOFError, ValueError, KeyError, StopIteration):
            # StopIteration: torn where what is left of a message reads as the end of a stream.
            at = _next_message(data, at)
            continue
        bad = _damaged(batch, header, schema, read.rows)
        if bad:
            suspects += bad
            at = _next_message(data, at)
        else:
            read.skip(header.first_row, suspects)
            read.add(batch, header.first_row)
            suspects, at = [], reader.tell()
    if suspects:
        read.damaged.append(f"rows from {read.rows + 1} on ({', '.join(suspects)})")
    return read


def _damaged(batch: pa.RecordBatch, header: BatchHeader, schema: bytes, rows: int) -> list[str]:
    """Return in words what of a batch is not as its header states; nothing of a batch that proves itself."""
    if header.schema_digest != _schema_digest(schema, header.first_row) or header.first_row < rows:
        return ["what the batch states of itself"]
    return [f"column {name}" for name in differing(header.columns, _digests(batch))]


def _schema_digest(schema: bytes, first_row: int) -> str:
    return digest(schema, str(first_row).encode())


def _batch(message: pa.ipc.Message, schema: bytes) -> tuple[pa.RecordBatch, BatchHeader]:
    """Return a batch and its header; raises an error of Arrow, `KeyError` or `ValueError` where either is damaged."""
    with pa.ipc.open_stream(schema + message.serialize().to_pybytes()) as stream:
        batch, metadata = stream.read_next_batch_with_custom_metadata()
    batch.validate(full=True)
    if metadata is None:
        raise KeyError(BATCH_KEY)
    try:
        return batch, BatchHeader.model_validate_json(metadata[BATCH_KEY])
    except ValidationError as error:
        raise ValueError(str(error)) from None


def _next_message(data: bytes, at: int) -> int:
    """Return where the next message may begin after `at`, -1 where none does."""
    at = data.find(MESSAGE_MARK, at + 1)
    while at >= 0 and at % ALIGNMENT:
        at = data.find(MESSAGE_MARK, at + 1)
    return at


def _digests(batch: pa.RecordBatch) -> dict[str, str]:
    return {name: column_digest(name, values) for name, values in batch_columns(batch).items()}


def _unverified(data: bytes) -> Batches:
    """Return the batches of a journal without digests, up to its end, regular or torn."""
    read = Batches()
    try:
        with pa.ipc.open_stream(data) as stream:
            for batch in stream:
                batch.validate(full=True)
                read.add(batch, read.rows)
    except (pa.ArrowException, OSError):
        pass
    return read
