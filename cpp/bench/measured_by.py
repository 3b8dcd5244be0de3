"""Shared by both pages of benchmarks: their command line, running a program, naming processor and compiler."""

from __future__ import annotations

import argparse
import json
import os
import platform
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path


def report(description: str | None, benchmark: str, make_page: Callable[[Path], str]) -> None:
    """Run the command line of a page: benchmark the program it names, print the page and write it to -o.

    Parameters
    ----------
    description : str
        Help text.
    benchmark : str
        Description of the benchmark in the message on stderr.
    make_page : callable
        Returns the page, given the path of the benchmark program.
    """
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("-o", "--output", type=Path)
    arguments = parser.parse_args()
    print(f"running {benchmark} ...", file=sys.stderr)
    page = make_page(arguments.program)
    if arguments.output:
        arguments.output.write_text(page, encoding="utf-8")
    print(page)


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
