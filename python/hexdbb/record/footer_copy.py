"""A second copy of a Parquet file's footer, at the beginning of the file.

The footer holds where every part of the data lies, its schema and all metadata; without it nothing can be read. It
stands at the end, which is what a file loses that is cut short. The copy lies between the magic number and the first
page, where readers look only if they are told to: every program reads the file as before.

Layout from byte 4: mark, length of the footer, length of the data before it (8 bytes each, little-endian), digest of
the footer, footer.
Source: Parquet format, file layout (magic number, pages, footer, its length, magic number).
"""

from __future__ import annotations

import struct
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from hexdbb.record.digests import DIGITS, digest

MAGIC = b"PAR1"
MARK = b"hexdbb footer, copy: "
HEAD = struct.Struct(f"<{len(MARK)}sQQ{DIGITS}s")
TAIL = struct.Struct(f"<I{len(MAGIC)}s")
"""End of a Parquet file: length of the footer, magic number."""
CHUNK_BYTES = 300
"""Bytes of the footer for each column of each row group, with room to spare: 170 to 260 are measured."""
SPARE_BYTES = 1024


def write_with_copy(table: pa.Table, path: Path, rows_per_group: int, **options: object) -> None:
    """Write a table as a Parquet file whose beginning holds a copy of its footer; `options` as of `ParquetWriter`."""
    groups = -(-len(table) // rows_per_group)
    room = len(_footer_of_none(table.schema, options)) + groups * table.num_columns * CHUNK_BYTES + SPARE_BYTES
    while True:
        with pa.OSFile(str(path), "wb") as sink, pq.ParquetWriter(sink, table.schema, **options) as writer:
            sink.write(bytes(room))
            writer.write_table(table, row_group_size=rows_per_group)
        with path.open("rb+") as file:
            footer, data_bytes = _footer(file.read())
            head = HEAD.pack(MARK, len(footer), data_bytes, digest(footer).encode())
            if len(head) + len(footer) <= room:
                file.seek(len(MAGIC))
                file.write(head + footer)
                return
        room = 2 * len(footer) + SPARE_BYTES


def rebuilt(path: Path) -> pa.BufferReader | None:
    """Return a damaged file with the copy of its footer in place of the footer; None where there is no whole copy."""
    data = path.read_bytes()
    if len(data) < len(MAGIC) + HEAD.size:
        return None
    mark, length, data_bytes, stated = HEAD.unpack_from(data, len(MAGIC))
    begin = len(MAGIC) + HEAD.size
    footer = data[begin : begin + length]
    if mark != MARK or stated != digest(footer).encode():
        return None
    # Of a file cut short the rest counts as damaged pages.
    pages = data[:data_bytes].ljust(data_bytes, b"\0")
    return pa.BufferReader(pages + footer + TAIL.pack(len(footer), MAGIC))


def _footer(data: bytes) -> tuple[bytes, int]:
    """Return the footer of a whole file, and the length of what stands before it."""
    length, _ = TAIL.unpack(data[-TAIL.size :])
    end = len(data) - TAIL.size
    return data[end - length : end], end - length


def _footer_of_none(schema: pa.Schema, options: dict[str, object]) -> bytes:
    sink = pa.BufferOutputStream()
    with pq.ParquetWriter(sink, schema, **options):
        pass
    return _footer(sink.getvalue().to_pybytes())[0]
