"""A study run: its cases as tasks of `hexdbb.cluster`, their rows in a dataset, and what all rows say.

A case's key is the hash of all that it follows from and of its number. Rows of another study do not mix with them: the
kind of a dataset has the study's hash in it.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from hexdbb.cluster import Cluster, ClusterOptions, Progress, Results, Summary, Task, content_key, run_tasks
from hexdbb.errors import InputError, RunError
from hexdbb.files.validation import format_value
from hexdbb.studies.kinds import study_named
from hexdbb.studies.setting import Setting
from hexdbb.studies.study import Case, Result, Row, Study
from hexdbb.threads import one_thread

CONTENT = "_study.json"
"""What the cases follow from: machine, plan, gauge and ranges; readers of Parquet datasets leave it out."""
Payload = tuple[str, Setting, Case]


@dataclass(frozen=True)
class Ran:
    """A study that was run.

    Attributes
    ----------
    summary : Summary
        What this run did.
    rows : sequence of mappings
        Of the cases asked for, in their order, those that failed left out.
    failed : mapping of str to int
        How many cases failed, by their error.
    result : Result
    """

    summary: Summary
    rows: Sequence[Row]
    failed: Mapping[str, int]
    result: Result


def results_of(study: Study, setting: Setting, url: str) -> Results:
    """Return the dataset of a study's cases at a URL."""
    return Results(url, f"hexdbb.study/1 {study.name} {setting.fingerprint(study.name)}", study.columns)


def run_study(
    study: Study,
    setting: Setting,
    url: str,
    where: ClusterOptions | Cluster,
    *,
    tell: Callable[[str], None] = lambda _: None,
    progress: Callable[[Progress], None] = lambda _: None,
    again: bool = False,
) -> Ran:
    """Run the cases of a study that are not done yet; return what all say.

    Parameters
    ----------
    study : Study
    setting : Setting
    url : str
        Folder of the dataset, local or at any URL of fsspec.
    where : ClusterOptions or Cluster
    tell, progress : callable
        As of `hexdbb.cluster.run_tasks`.
    again : bool
        Whether cases that failed are run again.

    Raises
    ------
    InputError
        The folder holds another study, or something else.
    RunError
        Every case failed; the first reason is named.
    """
    fingerprint = setting.fingerprint(study.name)
    cases = study.cases(setting)
    tasks = [
        Task(content_key(fingerprint, dict(case)), (study.name, setting, case), {"case": case["case"]})
        for case in cases
    ]
    results = results_of(study, setting, url)
    _begin(results, setting.content(study.name))
    summary = run_tasks(tasks, rows_of, results, where, tell=tell, progress=progress, again=again, most_in_call=4)
    asked = {task.key for task in tasks}
    table = [row for row in results.table().to_pylist() if row["task"] in asked]
    rows = sorted((row for row in table if row["error"] is None), key=lambda row: int(row["case"]))
    failed: dict[str, int] = {}
    for row in sorted((row for row in table if row["error"] is not None), key=lambda row: int(row["case"])):
        failed[row["error"]] = failed.get(row["error"], 0) + 1
    if not rows:
        raise RunError(f"{url}: every case failed: {next(iter(failed))}")
    return Ran(summary, rows, failed, study.result(setting, rows))


def _begin(results: Results, content: Mapping[str, Any]) -> None:
    """Make the dataset of a study, or check that it is of this one; what it is of is kept in it."""
    kept = next((path for path in results.storage.files() if path.rpartition("/")[2] == CONTENT), None)
    if kept is not None:
        try:
            found = json.loads(results.storage.read(kept))
        except ValueError:
            raise InputError(f"{results.storage.named(kept)}: damaged (expected what a study is)") from None
        if found != content:
            where, was, wanted = _difference(found, content, "")
            raise InputError(
                f"{results.url}: results of another study, whose {where} is {was}"
                f" (expected {wanted}, as in this one, or another folder: --output)"
            )
    results.begin()
    results.storage.write(CONTENT, json.dumps(content, indent=2, sort_keys=True).encode() + b"\n")


def _difference(one: Any, other: Any, where: str) -> tuple[str, str, str]:
    """Return where two contents first differ, and what each has there."""
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        for key in sorted({*one, *other}):
            if one.get(key) != other.get(key):
                return _difference(one.get(key), other.get(key), f"{where}.{key}".lstrip("."))
    if isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        for place, (first, second) in enumerate(zip(one, other, strict=True)):
            if first != second:
                return _difference(first, second, f"{where}[{place}]")
    return where, format_value(one), format_value(other)


@one_thread
def rows_of(payload: Payload) -> list[dict[str, Any]]:
    """Return the row of one case, on whatever worker."""
    name, setting, case = payload
    return [dict(study_named(name).row(setting, case))]
