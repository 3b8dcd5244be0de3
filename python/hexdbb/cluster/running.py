"""Many tasks run: those done before left out, the others in parts whose rows are written as soon as they are complete.

Tasks are handed to Dask in the order given, some in one call, and their rows are written in consecutive groups: what a
part of the dataset holds follows from the tasks alone, not from the workers' number or speed. This process alone
writes: whatever dies, a part is there or not, and a task's rows are there once.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack

import pyarrow as pa

from hexdbb.cluster.connection import Cluster, Tell, connected
from hexdbb.cluster.failures import run_apart, run_singly
from hexdbb.cluster.options import ClusterOptions
from hexdbb.cluster.part import Function, Outcome, Work, run_items
from hexdbb.cluster.results import ERROR, TASK, Results
from hexdbb.cluster.submitted import Submitted
from hexdbb.cluster.tasks import Progress, Summary, Task

MOST_PARTS, MOST_IN_PART = 64, 2000
"""A run's rows are written in so many groups at most, unless one would have more than so many tasks: what a run that
dies has to do again is a sixty-fourth, and 10,000 tasks make no more files than 64 times the partitions of a group."""
LEAST_IN_PART = 16
"""Tasks of a group at least: a file takes the time of some short tasks to write."""
MOST_IN_CALL = 16
"""Tasks of one call at most: Dask takes a millisecond for a call, the shortest tasks take ten."""
CALLS_EACH = 32
"""Calls for each worker at least, where there are tasks enough: the last ones then end within 3 % of the run."""
WINDOW = 1000
"""Calls that Dask knows of at a time: enough for a cluster that grows with its queue, some MB in the scheduler."""
TICK_S = 0.5
"""Time between two reports of progress."""
LOST_S = 60.0
"""Time without any worker after which a run ends: a batch system that replaces workers does so within."""


def run_tasks(
    tasks: Iterable[Task],
    function: Function,
    results: Results,
    where: ClusterOptions | Cluster,
    *,
    tell: Tell = lambda _: None,
    progress: Callable[[Progress], None] = lambda _: None,
    again: bool = False,
    most_in_call: int = MOST_IN_CALL,
) -> Summary:
    """Run tasks that are not done yet, and write their rows.

    Parameters
    ----------
    tasks : iterable of Task
        Of one key, the first counts.
    function : callable
        Returns the rows of a payload, mappings by column; importable by its name, on workers too. A task has one row
        at least, and all its rows lie in one partition.
    results : Results
        Where rows are written; one run at a time.
    where : ClusterOptions or Cluster
        Where tasks run. No cluster is made where everything is done.
    tell : callable
        Is told in a line what the cluster is.
    progress : callable
        Is told twice a second how far the run is.
    again : bool
        Whether tasks that failed in an earlier run are run again.
    most_in_call : int
        Tasks handed to a worker at a time, at most: 1 where a task takes seconds.

    Returns
    -------
    Summary

    Raises
    ------
    InputError
        What `connected` and `Results.begin` refuse; a worker that joined later has another hexdbb.
    RunError
        Rows cannot be written; the scheduler is gone or has no worker any more. What is written stays, and the same
        run, started again, does the rest.
    """
    by_key: dict[str, Task] = {}
    for task in tasks:
        by_key.setdefault(task.key, task)
    known = results.begin(again=again)
    left = [task for key, task in by_key.items() if key not in known]
    total, before = len(by_key), len(by_key) - len(left)
    if not left:
        return Summary(total, before)
    with ExitStack() as stack:
        cluster = where if isinstance(where, Cluster) else stack.enter_context(connected(where, tell))
        work = Work(function, results.schema, results.partition, cluster.environment)
        run = _Run(results, {task.key: task for task in left}, total, before, progress)
        submitted = stack.enter_context(Submitted(cluster.client, LOST_S, TICK_S, run.report))
        run.all_of(submitted, work, max(1, min(most_in_call, len(left) // (CALLS_EACH * cluster.workers))))
        return run.summary()


class _Run:
    """The state of a run: what is done, and the rows that wait for others of their group."""

    def __init__(
        self,
        results: Results,
        tasks: dict[str, Task],
        total: int,
        before: int,
        progress: Callable[[Progress], None],
    ) -> None:
        self.results, self.tasks, self.progress = results, tasks, progress
        self.total, self.before = total, before
        self.done, self.failed, self.rows = 0, 0, 0
        self.busy_s, self.peak_bytes = 0.0, 0
        self.begun = time.monotonic()

    def all_of(self, submitted: Submitted, work: Work, in_call: int) -> None:
        """Run every task: some in a call, then those that failed by themselves, then those whose worker died apart."""
        group = min(MOST_IN_PART, max(LEAST_IN_PART, -(-len(self.tasks) // MOST_PARTS)))
        in_call = min(in_call, group)
        groups = [list(each) for each in _cut(list(self.tasks), group)]
        waiting = {number: _Group(len(keys)) for number, keys in enumerate(groups)}
        calls = ((number, keys) for number, own in enumerate(groups) for keys in _cut(own, in_call))
        again: list[str] = []
        suspects: list[str] = []
        try:
            for (number, keys), outcome in submitted.each(
                calls, lambda call: (run_items, work, [(key, self.tasks[key].payload) for key in call[1]]), WINDOW
            ):
                if isinstance(outcome, Outcome):
                    self._count(outcome)
                    again += outcome.failed
                    self.done += len(keys) - len(outcome.failed)
                else:
                    (suspects if submitted.is_death(outcome) else again).extend(keys)
                rows = waiting[number].with_part(keys, outcome)
                if rows is not None:
                    self._write(rows)
        finally:  # what a run that ends early has in hand is not computed again
            rest = [rows for group in waiting.values() for rows in group.parts]
            if rest:
                self._write(pa.concat_tables(rest))
        self._retried(submitted, work, again, suspects)

    def _retried(self, submitted: Submitted, work: Work, again: list[str], suspects: list[str]) -> None:
        """Run tasks again that failed, and write what comes of them as parts of their own."""
        found: dict[str, Outcome | str] = {}
        items = {key: self.tasks[key].payload for key in sorted(again)}
        for key, outcome in run_singly(submitted, work, items, WINDOW):
            if outcome is None:
                suspects.append(key)
            else:
                self._settle(found, key, outcome)
        for key, outcome in run_apart(submitted, work, {key: self.tasks[key].payload for key in sorted(suspects)}):
            self._settle(found, key, outcome)
        good = [each.rows for _, each in sorted(found.items()) if isinstance(each, Outcome)]
        if good:
            self._write(pa.concat_tables(good))
        bad = {key: each for key, each in sorted(found.items()) if isinstance(each, str)}
        if bad:
            rows = [{**self.tasks[key].labels, TASK: key, ERROR: error} for key, error in bad.items()]
            self._write(pa.Table.from_pylist(rows, self.results.schema), failed=True)

    def _settle(self, found: dict[str, Outcome | str], key: str, outcome: Outcome | str) -> None:
        found[key] = outcome
        self.done += 1
        if isinstance(outcome, Outcome):
            self._count(outcome)
        else:
            self.failed += 1

    def _count(self, outcome: Outcome) -> None:
        self.busy_s += outcome.busy_s
        self.peak_bytes = max(self.peak_bytes, outcome.peak_bytes)

    def _write(self, rows: pa.Table, failed: bool = False) -> None:
        self.results.write(rows, set(rows[TASK].to_pylist()), failed=failed)
        self.rows += len(rows)

    def report(self) -> None:
        """Report the progress of the run."""
        elapsed_s = time.monotonic() - self.begun
        self.progress(Progress(self.total, self.before, self.done, self.failed, elapsed_s))

    def summary(self) -> Summary:
        """Return what the run did."""
        elapsed_s = time.monotonic() - self.begun
        self.report()
        return Summary(
            self.total, self.before, self.done, self.failed, self.rows, elapsed_s, self.busy_s, self.peak_bytes
        )


class _Group:
    """Consecutive tasks whose rows are written together."""

    def __init__(self, tasks: int) -> None:
        self.left = tasks
        self.parts: list[pa.Table] = []

    def with_part(self, keys: Sequence[str], outcome: Outcome | BaseException) -> pa.Table | None:
        """Add some tasks' rows; return all where none is missing any more, and there are any."""
        self.left -= len(keys)
        if isinstance(outcome, Outcome) and len(outcome.rows):
            self.parts.append(outcome.rows)
        if self.left or not self.parts:
            return None
        parts, self.parts = self.parts, []
        return pa.concat_tables(parts)


def _cut(keys: Sequence[str], size: int) -> Iterator[Sequence[str]]:
    for first in range(0, len(keys), size):
        yield keys[first : first + size]
