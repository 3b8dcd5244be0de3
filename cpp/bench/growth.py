"""Time and memory of a diagnosis as readings grow from 20,000 to 2,000,000: one plan driven 1, 10 and 100 times.

Usage: growth.py [RECORD]
Every size runs in a process of its own, so that its peak memory is its own; with RECORD, that one record is diagnosed
and its row printed as JSON.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from hexdbb.diagnosis import diagnose
from hexdbb.model import new_model
from hexdbb.record import Record, read_record, write_record
from hexdbb.samples import Samples, predict

TIMES_DRIVEN = (1, 10, 100)
NOISE_UM = 0.5
LARGEST_MB = 1000
"""Peak memory of the largest size: what a controller PC or a worker of a fleet has for one task."""
BETWEEN_S = 1.0
"""Pause between two runs of the plan."""


@dataclass(frozen=True)
class Growth:
    """What one size takes: processor time of reading the record, of preparing and of diagnosing it, peak memory."""

    readings: int
    read_s: float
    diagnose_s: float
    peak_mb: float


def measured(path: Path) -> Growth:
    """Read a record and diagnose its machine, without held-out circles: those are seven fits more of the same size."""
    begin = time.process_time()
    record = read_record(path)
    samples = Samples.of([record])
    read_s = time.process_time() - begin
    found = diagnose(samples, new_model(record.machine), check_held_out=False)
    diagnose_s = time.process_time() - begin - read_s
    # Of this program alone: the peak that getrusage states is at least that of the process it was started from.
    status = Path("/proc/self/status").read_text(encoding="ascii")
    peak_mb = int(next(line for line in status.splitlines() if line.startswith("VmHWM:")).split()[1]) / 1024.0
    return Growth(len(found.residual_mm), read_s, diagnose_s, peak_mb)


def driven(record: Record, times: int) -> Record:
    """Return the record of a plan driven several times: readings of the diagnosed machine, noise of their own."""
    samples = Samples.of([record])
    fitted = diagnose(samples, new_model(record.machine), check_held_out=False).model
    exact_um = predict(samples, fitted).reading_mm * 1e3
    columns = {name: np.tile(column, times) for name, column in record.columns.items()}
    run = np.repeat(np.arange(times), len(record))
    of_one = record.columns["t_s"][-1] - record.columns["t_s"][0] + BETWEEN_S
    columns["t_s"] = columns["t_s"] + run * of_one
    columns["sweep"] = columns["sweep"] + run * (int(record.columns["sweep"].max()) + 1)
    columns["reading_um"] = np.tile(exact_um, times) + np.random.default_rng(1).normal(0.0, NOISE_UM, len(run))
    return replace(record, columns=columns, path=None, origin=None)


def growth_rows(record: Record) -> list[str]:
    """Return table rows: readings, processor time per reading, peak memory."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for times in TIMES_DRIVEN:
            path = Path(folder) / f"{times}.parquet"
            write_record(driven(record, times), path)
            said = subprocess.run([sys.executable, __file__, str(path)], check=True, capture_output=True, text=True)
            found.append(Growth(**json.loads(said.stdout)))
    rows = []
    for each in found:
        per_reading_us = (each.read_s + each.diagnose_s) / each.readings * 1e6
        rows.append(
            f"| {each.readings:,} | {each.read_s:.2f} s | {each.diagnose_s:.2f} s | {per_reading_us:.1f} µs |"
            f" {each.peak_mb:,.0f} MB |"
        )
    return rows


HEADER = [
    "| readings | reading the record | diagnosis without held-out circles | a reading | peak memory |",
    "|---|---|---|---|---|",
]


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print(json.dumps(vars(measured(Path(sys.argv[1])))))
    else:
        from discovery_times import PACE

        from hexdbb_truth.cases import case

        print("\n".join([*HEADER, *growth_rows(case("none-s1", PACE).record())]))
