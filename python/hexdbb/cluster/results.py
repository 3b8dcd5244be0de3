"""The rows of tasks as a Parquet dataset, partitioned as Hive does: ``machine=a/month=2026-03/part-4f1c….parquet``.

pandas, DuckDB and Spark read the folder as it is. A part has the rows of many tasks and is there whole or not at all;
all rows of one task lie in one part, so the column `task` says what is done and no other index is kept. Rows of tasks
that failed lie in parts of their own, ``failed-….parquet``, which may be removed to have these tasks tried again.
"""

from __future__ import annotations

import hashlib
import io
import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from urllib.parse import quote

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.dataset as pads
import pyarrow.parquet as pq

from hexdbb.cluster.storage import Storage, storage_of
from hexdbb.errors import InputError, RunError

TASK, ERROR = "task", "error"
"""Columns that every dataset has: key of the task, and why it failed (null where it did not)."""
ABOUT = "_about.json"
"""States what the dataset is; readers of Parquet datasets leave out names that begin with an underscore."""
PART, FAILED = "part", "failed"
NO_VALUE = "__HIVE_DEFAULT_PARTITION__"
"""Hive's name of a partition without a value."""
ZSTD_FROM = 1000
"""Rows of a part from which zstd is worth its time: it then takes a sixth less space than snappy. Of 40 rows both make
the same size, and to prepare zstd for each column doubles the time of writing them."""
NAMED_BY = 16
"""Hexadecimal digits in a part's name: two of a million parts share one with a probability of one in 10^7."""


@dataclass(frozen=True)
class Results:
    """A dataset of rows, at any URL that fsspec knows.

    Attributes
    ----------
    url : str
        Folder of the dataset.
    kind : str
        What rows it has, as ``hexdbb.fleet/1``; a dataset of another kind is refused.
    columns : pyarrow.Schema
        Of plain types, those of `partition` included; `task` and `error` are added.
    partition : tuple of str
        Columns of text that name folders.
    """

    url: str
    kind: str
    columns: pa.Schema
    partition: tuple[str, ...] = ()

    @cached_property
    def schema(self) -> pa.Schema:
        """Columns of a row, `task` first and `error` last."""
        return pa.schema([(TASK, pa.string()), *self.columns, (ERROR, pa.string())])

    @cached_property
    def storage(self) -> Storage:
        """The files of the dataset."""
        return storage_of(self.url)

    def begin(self, *, again: bool = False) -> set[str]:
        """Make the dataset where there is none; return the keys of the tasks that are done.

        Parameters
        ----------
        again : bool
            Remove the rows of failed tasks first.

        Raises
        ------
        InputError
            The folder holds something else, or a dataset of another kind.
        RunError
            It cannot be read or written; a part is damaged.
        """
        files = self.storage.files()
        if self._about(files) is None:
            about = json.dumps({"schema": self.kind, "columns": self.schema.names}, indent=2)
            self.storage.write(ABOUT, about.encode() + b"\n")  # said before anything is computed if it cannot be
        if again:
            for path in files:
                if _kind_of(path) == FAILED:
                    self.storage.remove(path)
        parts = [path for path in self.storage.files() if _kind_of(path)]
        return set(pc.unique(self._read(parts, [TASK])[TASK]).to_pylist()) if parts else set()

    def table(self, columns: Sequence[str] | None = None) -> pa.Table:
        """Return all rows, in the order of tasks' keys; those of one task in the order in which it made them.

        Parameters
        ----------
        columns : sequence of str, optional
            Some columns only.

        Raises
        ------
        InputError
            There is no dataset of this kind.
        RunError
            A part is damaged, or the store refuses.
        """
        files = self.storage.files()
        if self._about(files) is None:
            raise InputError(f"{self.url}: no results (expected a folder of {self.kind})")
        parts = [path for path in files if _kind_of(path)]
        asked = list(columns) if columns is not None else self.schema.names
        if not parts:
            return pa.table({name: pa.array([], self.schema.field(name).type) for name in asked})
        keys = asked if TASK in asked else [TASK, *asked]
        table = self._read(parts, keys)
        return _sorted(table).select(asked)

    def write(self, rows: pa.Table, keys: Iterable[str], *, failed: bool = False) -> None:
        """Write rows as one part in each partition that they belong to.

        Parameters
        ----------
        rows : pyarrow.Table
            Of `schema`.
        keys : iterable of str
            Of the tasks that they are of, which name the part.
        failed : bool
            Whether these tasks failed.

        Raises
        ------
        RunError
            A part cannot be written; parts written before it stay.
        """
        rows = _sorted(rows)
        digest = hashlib.sha256("\n".join(sorted(keys)).encode()).hexdigest()[:NAMED_BY]
        name = f"{FAILED if failed else PART}-{digest}.parquet"
        for folder, own in self._by_partition(rows):
            held = pa.BufferOutputStream()
            compression = "zstd" if len(own) >= ZSTD_FROM else "snappy"
            pq.write_table(own, held, compression=compression, write_page_checksum=True)
            self.storage.write(f"{folder}{name}", held.getvalue().to_pybytes())

    def _by_partition(self, rows: pa.Table) -> list[tuple[str, pa.Table]]:
        """Return the rows of every partition without the columns that its folder names, sorted by its folder."""
        if not self.partition:
            return [("", rows)]
        ordered = rows.take(pc.sort_indices(rows, [(name, "ascending") for name in self.partition]))  # stable
        values = list(zip(*(ordered[name].to_pylist() for name in self.partition), strict=True))
        begins = [place for place, each in enumerate(values) if place == 0 or each != values[place - 1]]
        plain = ordered.drop_columns(list(self.partition)).combine_chunks()
        found = []
        for begin, end in pairwise([*begins, len(values)]):
            named = zip(self.partition, values[begin], strict=True)
            folder = "".join(f"{key}={NO_VALUE if value is None else quote(value, safe='')}/" for key, value in named)
            found.append((folder, plain.slice(begin, end - begin)))
        return sorted(found, key=lambda pair: pair[0])

    def _read(self, parts: list[str], columns: list[str]) -> pa.Table:
        fields = [(name, self.schema.field(name).type) for name in self.partition]
        try:
            return pads.dataset(
                parts,
                schema=self.schema,
                format="parquet",
                filesystem=self.storage.system,
                partitioning=pads.partitioning(pa.schema(fields), flavor="hive") if fields else None,
                partition_base_dir=self.storage.root,
            ).to_table(columns=columns)
        except (pa.ArrowException, OSError) as error:
            raise self._damage(parts, error) from error

    def _damage(self, parts: list[str], error: BaseException) -> RunError:
        """Return the error of parts that cannot be read: it names the first that is not whole."""
        for path in parts:
            try:
                pq.read_schema(io.BytesIO(self.storage.read(path)))
            except (pa.ArrowException, OSError):
                named = self.storage.named(path)
                return RunError(f"{named}: damaged (expected a whole part; remove it and run again)")
        return RunError(f"{self.url}: cannot be read: {next(iter(str(error).splitlines()), 'damaged')}")

    def _about(self, files: list[str]) -> str | None:
        """Return the kind of the dataset; None where the folder is empty."""
        about = next((path for path in files if path.rpartition("/")[2] == ABOUT), None)
        if about is None:
            if files:
                raise InputError(
                    f"{self.url}: holds other files, as {self.storage.named(files[0])}"
                    " (expected an empty folder, or one of results)"
                )
            return None
        try:
            kind = json.loads(self.storage.read(about))["schema"]
        except (ValueError, KeyError, TypeError):
            raise InputError(f"{self.storage.named(about)}: damaged (expected what a dataset of results is)") from None
        if kind != self.kind:
            raise InputError(f"{self.url}: results of {kind} (expected {self.kind}, or an empty folder)")
        return str(kind)


def _sorted(rows: pa.Table) -> pa.Table:
    """Return rows by the keys of their tasks, those of one task as they were: not in the order in which they ended."""
    return rows.take(pc.sort_indices(rows[TASK]))  # stable


def _kind_of(path: str) -> str:
    """Return whether a file is a part of results, of failed tasks, or (empty) none."""
    name = path.rpartition("/")[2]
    kind = name.partition("-")[0]
    return kind if kind in (PART, FAILED) and name.endswith(".parquet") else ""
