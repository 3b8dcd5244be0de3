"""Shared by both pages of benchmarks: running a benchmark program, and naming processor and compiler."""

from __future__ import annotations

import json
import os
import platform
import subprocess
from pathlib import Path


def median_rows(program: Path, repetitions: int) -> dict[str, dict[str, float]]:
    """Return the median row of each benchmark of a Google Benchmark program, by its name."""
    command = [
        str(program),
        f"--benchmark_repetitions={repetitions}",
        "--benchmark_report_aggregates_only=true",
        "--benchmark_format=json",
    ]
    output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return {row["run_name"]: row for row in json.loads(output)["benchmarks"] if row["aggregate_name"] == "median"}


def processor() -> str:
    """Return the processor's name, its cores, and the vector instructions among which the engine chooses."""
    text = Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").exists() else ""
    name = next((line.split(":", 1)[1].strip() for line in text.splitlines() if line.startswith("model name")), "")
    flags = next((line.split() for line in text.splitlines() if line.startswith("flags")), [])
    vector = [flag for flag in ("sse2", "avx2", "fma", "avx512f") if flag in flags]
    return f"{name or platform.machine()}, {os.cpu_count()} cores, {' '.join(vector)}"


def compiler() -> str:
    """Return the name of the C++ compiler."""
    output = subprocess.run(["c++", "--version"], check=True, capture_output=True, text=True).stdout
    return output.splitlines()[0]
