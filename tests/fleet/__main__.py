"""Figures of docs/fleet.md: `python -m tests.fleet --records 10000 --machines 40 --page docs/fleet.md`.

Makes records of a fleet whose faults are known, diagnoses them with one worker and with two, and prints throughput,
speed-up, what a record costs beside its computation, the engine's share of the time, and what a million records a day
would need; `--page` writes them into the page's last section. The share is measured apart, in this process: calls of
the engine are timed while some records are judged, of that plan and of the standard one.
"""

from __future__ import annotations

import os
import platform
import shutil
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from types import BuiltinFunctionType
from typing import Any
from unittest import mock

import click
import numpy as np
from tests.fleet.made import PACES, Fleet, write_model

from hexdbb import _core
from hexdbb.cluster import ClusterOptions, Summary
from hexdbb.cluster.worker_process import prepare_process
from hexdbb.fleet import fleet_results, judge_records, list_records
from hexdbb.fleet.judging import judge
from hexdbb.record import read_record

SHARED = 40
"""Records judged for the engine's share: its median settles within a per cent."""
SECONDS_A_DAY = 86400.0
MILLION = 1_000_000
DISK = 1e9
CORE_HOUR_EUR = 0.04
"""Assumed price of a core for an hour."""
SECTION = "## What it costs"


@dataclass(frozen=True)
class Share:
    """Time of one record, s: all of it, inside the engine, and to read the file and prove that it is whole."""

    whole_s: float
    engine_s: float
    file_s: float
    readings: int
    model: str


@click.command(help=__doc__)
@click.option("--records", default=400, show_default=True)
@click.option("--machines", default=8, show_default=True)
@click.option("--plan", type=click.Choice(list(PACES)), default="small", show_default=True, help="What is driven.")
@click.option("--page", type=click.Path(path_type=Path), help="Page whose last section is written anew.")
@click.option("--folder", type=click.Path(path_type=Path), help="Keep records there; made ones are used again.")
def main(records: int, machines: int, plan: str, page: Path | None, folder: Path | None) -> None:
    with ExitStack() as stack:
        kept = folder or Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="hexdbb-fleet-")))
        fleet = Fleet(machines, records, plan)
        make(fleet, kept / "records")
        model = write_model(kept / "model.toml").read_text()
        share = engine_share(fleet, kept / "records", model)
        long = Fleet(machines, SHARED, "standard")
        make(long, kept / "standard")
        standard = engine_share(long, kept / "standard", model)
        geometric = engine_share(long, kept / "standard", None)
        runs = {workers: judged(kept, model, workers) for workers in (1, 2)}
        lines = told(fleet, (share, standard, geometric), runs, kept)
    click.echo("\n".join(lines))
    if page is not None:
        before = page.read_text(encoding="utf-8").partition(SECTION)[0]
        command = f"python -m tests.fleet --records {records} --machines {machines}"
        command += f" --plan {plan}" if plan != "small" else ""
        page.write_text(f"{before}{SECTION}\nMeasured by `{command}`:\n\n{table(lines)}", encoding="utf-8")


def table(lines: list[str]) -> str:
    """Return the figures as a table of the page."""
    rows = [f"| {name} | {figure} |" for name, _, figure in (line.partition(": ") for line in lines)]
    return "\n".join(["| what | measured |", "|---|---|", *rows, ""])


def make(fleet: Fleet, folder: Path) -> None:
    with ProcessPoolExecutor() as processes:
        list(processes.map(partial(fleet.write, folder), range(fleet.records), chunksize=16))


def judged(folder: Path, model: str, workers: int) -> Summary:
    """Judge all records anew, as `hexdbb fleet diagnose` does."""
    results = folder / f"results-{workers}"
    shutil.rmtree(results, ignore_errors=True)
    listing = list_records([str(folder / "records")], "diagnose", model)
    return judge_records(listing, fleet_results(str(results)), ClusterOptions(workers=workers))


def engine_share(fleet: Fleet, folder: Path, model: str | None) -> Share:
    """Time some records with a clock around every function of the engine and what makes samples; the median of each.

    Without a model, geometric errors are fitted, as `hexdbb fleet diagnose` does where none is given.
    """
    inside = 0.0

    def timed(function: Any) -> Any:
        def call(*words: Any, **named: Any) -> Any:
            nonlocal inside
            begun = time.perf_counter()
            try:
                return function(*words, **named)
            finally:
                inside += time.perf_counter() - begun

        return call

    functions = [(_core, name) for name, each in vars(_core).items() if isinstance(each, BuiltinFunctionType)]
    functions += [(_core.Samples, name) for name in ("__init__", "derive", "rows", "column")]
    functions += [(_core.CaptureHarmonics, name) for name in ("__init__", "split")]
    prepare_process()  # as a worker does
    found = []
    with ExitStack() as stack:
        for owner, name in functions:
            stack.enter_context(mock.patch.object(owner, name, timed(getattr(owner, name))))
        for number in range(min(SHARED, fleet.records)):
            path = str(folder / fleet.file(number * fleet.records // min(SHARED, fleet.records)))
            begun, inside = time.perf_counter(), 0.0
            rows = judge({"source": path, "files": [path], "command": "diagnose", "model": model})
            whole_s, engine_s = time.perf_counter() - begun, inside
            begun = time.perf_counter()
            read_record(Path(path)).content_hash()  # what judging does before the engine has anything to do
            found.append((whole_s, engine_s, time.perf_counter() - begun))
    fitted = "geometric errors" if model is None else "geometric errors and play"
    whole_s, engine_s, file_s = np.median(found, axis=0)
    return Share(whole_s, engine_s, file_s, rows[0]["readings"], fitted)


def told(fleet: Fleet, shares: tuple[Share, ...], runs: dict[int, Summary], folder: Path) -> list[str]:
    """Return the figures as lines."""
    one, two = runs[1], runs[2]
    rows = size(folder / "results-2") / fleet.records
    overhead_s = one.elapsed_s / one.done - one.busy_s / one.done
    core_s = two.busy_s / two.done + overhead_s
    cores = MILLION * core_s / SECONDS_A_DAY
    gigabytes = MILLION * rows / DISK
    files = sum(1 for _ in (folder / "results-2").rglob("*.parquet"))
    return [
        f"records: {fleet.records} of {fleet.machines} machines, {shares[0].readings} readings,"
        f" {size(folder / 'records') / fleet.records / 1e3:.0f} kB each; {platform.machine()}, {os.cpu_count()} cores",
        *(
            f"{workers} worker{'s' if workers > 1 else ''}: {run.done / run.elapsed_s:.1f} records/s"
            f" ({run.elapsed_s:.1f} s, {run.failed} failed), at most {run.peak_bytes / 2**20:.0f} MiB a worker"
            for workers, run in runs.items()
        ),
        f"speed-up: {one.elapsed_s / two.elapsed_s:.2f}",
        *(
            f"a record of {share.readings} readings, {share.model}: {1e3 * share.whole_s:.1f} ms, of these"
            f" in the engine {1e3 * share.engine_s:.1f} ms ({share.engine_s / share.whole_s:.0%}), for the file"
            f" {1e3 * share.file_s:.1f} ms; {1.0 / share.engine_s:.0f} records/s of engine time"
            for share in shares
        ),
        f"overhead of the cluster: {1e3 * overhead_s:.2f} ms a record ({overhead_s * one.done / one.elapsed_s:.1%})",
        f"results: {rows / 1e3:.1f} kB a record, {files} files",
        f"a million records a day: {cores:.1f} cores, {24 * cores * CORE_HOUR_EUR:.0f} EUR a day at an assumed"
        f" {CORE_HOUR_EUR} EUR a core and hour; {gigabytes:.1f} GB of results a day",
    ]


def size(folder: Path) -> int:
    return sum(path.stat().st_size for path in folder.rglob("*.parquet"))


if __name__ == "__main__":
    main()
