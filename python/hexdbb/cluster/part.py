"""What a worker does with some tasks: rows of each as one table, with the errors of those that failed."""

from __future__ import annotations

import resource
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import pyarrow as pa

from hexdbb.cluster.environment import Environment, difference, own_environment
from hexdbb.cluster.options import require
from hexdbb.cluster.results import TASK
from hexdbb.cluster.worker_process import prepare_process
from hexdbb.errors import HexdbbError, InputError

Rows = Sequence[Mapping[str, Any]]
Function = Callable[[Any], Rows]
Item = tuple[str, Any]
"""Key and payload of a task."""


class OtherVersionError(InputError):
    """Raised where a worker that joined later has another hexdbb."""


@dataclass(frozen=True)
class Work:
    """What workers are to do with every task.

    Attributes
    ----------
    function : callable
        Rows of a payload; importable by its name.
    schema : pyarrow.Schema
        Of the rows.
    partition : tuple of str
        Columns in which all rows of a task agree.
    environment : dict of str
        Versions that the worker must have.
    """

    function: Function
    schema: pa.Schema
    partition: tuple[str, ...]
    environment: Environment


@dataclass(frozen=True)
class Outcome:
    """What became of some tasks.

    Attributes
    ----------
    rows : pyarrow.Table
    failed : dict of str
        Error of every task that failed, by its key.
    busy_s : float
        Time of the function.
    peak_bytes : int
        Largest memory of the process so far.
    """

    rows: pa.Table
    failed: dict[str, str] = field(default_factory=dict)
    busy_s: float = 0.0
    peak_bytes: int = 0


def run_items(work: Work, items: Sequence[Item]) -> Outcome:
    """Run some tasks one after another; one that raises does not end the others.

    Raises
    ------
    OtherVersionError
        This worker has another hexdbb.
    """
    _require_version(work)
    rows: list[Mapping[str, Any]] = []
    failed: dict[str, str] = {}
    begun = time.perf_counter()
    for item in items:
        try:
            rows += _rows_of(work, item)
        except Exception as error:  # whatever it is, it is the task's, and is told in its row
            failed[item[0]] = described(error)
    return Outcome(pa.Table.from_pylist(rows, work.schema), failed, time.perf_counter() - begun, _peak_bytes())


def run_alone(work: Work, item: Item) -> Outcome:
    """Run one task; raises what it raises, so that Dask tries it again."""
    _require_version(work)
    begun = time.perf_counter()
    rows = pa.Table.from_pylist(_rows_of(work, item), work.schema)
    return Outcome(rows, {}, time.perf_counter() - begun, _peak_bytes())


def _rows_of(work: Work, item: Item) -> list[Mapping[str, Any]]:
    """Return the rows of a task with its key; they tell that it is done, all in one part."""
    rows: list[Mapping[str, Any]] = [{TASK: item[0], **row} for row in work.function(item[1])]
    parts = {tuple(row.get(name) for name in work.partition) for row in rows}
    if len(parts) != 1:
        raise ValueError(f"rows in {len(parts)} partitions (expected one row at least, all in one partition)")
    return rows


def described(error: BaseException) -> str:
    """Return an error as the text of a row: what it says, with its class where that is not one of hexdbb."""
    said = next(iter(str(error).splitlines()), "")
    return said if isinstance(error, HexdbbError) else f"{type(error).__name__}: {said}".removesuffix(": ")


def _require_version(work: Work) -> None:
    own = _own()
    if own != work.environment:
        wrong = difference(str(require("distributed").get_worker().address), own, work.environment)
        if wrong is not None:
            raise OtherVersionError(wrong)


@cache
def _own() -> Environment:
    """Return the versions of this process, once, and prepare it for the work."""
    prepare_process()
    return own_environment()


def _peak_bytes() -> int:
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit
