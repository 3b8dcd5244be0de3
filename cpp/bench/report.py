"""Run the engine's benchmark and, in the same call, SciPy on the same task; write the table of docs/benchmarks.md.

Usage: report.py BENCHMARK_PROGRAM [-o docs/benchmarks.md]
Times are medians of repetitions on a machine that may be busy: look at the ratios.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import scipy
from numpy.typing import NDArray
from scipy.optimize import fsolve

from hexdbb import _core
from hexdbb.kinematics import engine_machine, inverse
from hexdbb.machine import shipped_machine

REPETITIONS = 9
TARGET_NS = {
    "inverse_pose": 25,
    "forward_warm/level": 150,
    "forward_warm/tilted": 150,
    "forward_home/level": 250,
    "forward_home/tilted": 250,
}
TITLES = {
    "inverse_pose": "inverse kinematics, one pose",
    "forward_warm/level": "forward (RSSR), level, start 0.1 mm away",
    "forward_warm/tilted": "forward (RSSR), tilted to 8.6°, start 0.1 mm away",
    "forward_home/level": "forward (RSSR), level, from home",
    "forward_home/tilted": "forward (RSSR), tilted, from home",
    "forward_six_warm": "forward (six coordinates), start 0.1 mm away",
    "sensitivity": "reading's derivative at all 55 ports (RSSR)",
    "sensitivity_six": "reading's derivative at all 55 ports (6×6)",
}
ELSEWHERE = """\
Measured elsewhere, on two shared cores of an EPYC with g++ 12 `-O3 -march=native` (quoted, not run here): LinuxCNC's
genhexkins forward 1455-1715 ns level and 4400-5200 ns tilted, inverse 195-240 ns; Pinocchio's loop 7400 ns.
"""


def engine_times_ns(program: Path) -> dict[str, float]:
    """Median CPU time of each benchmark of the C++ program."""
    command = [
        str(program),
        f"--benchmark_repetitions={REPETITIONS}",
        "--benchmark_report_aggregates_only=true",
        "--benchmark_format=json",
    ]
    output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    rows = json.loads(output)["benchmarks"]
    return {row["run_name"]: row["cpu_time"] for row in rows if row["aggregate_name"] == "median"}


def scipy_forward_ns() -> float:
    """Forward kinematics by scipy.optimize.fsolve on the six leg lengths, start 0.1 mm away, tolerance 1e-12."""
    machine = shipped_machine()
    engine = engine_machine(machine)
    vertex = np.array([_core.guideway_vertex(engine, k // 2) for k in range(6)])
    direction = np.array([_core.guideway_direction(k // 2) for k in range(6)])
    joint = np.array([_core.platform_joint(engine, k // 2) for k in range(6)])
    random = np.random.default_rng(20060701)
    position = random.uniform([-100, -100, 265], [100, 100, 295], (200, 3))
    sliders, status = inverse(machine, position, np.zeros(3))
    position, sliders = position[status == 0][:50], sliders[status == 0][:50]

    def leg_errors(x: NDArray[np.float64], base: NDArray[np.float64]) -> NDArray[np.float64]:
        rotation = _core.rotation_from_rpy(*x[3:])
        lengths: NDArray[np.float64] = np.linalg.norm(x[:3] + joint @ rotation.T - base, axis=1)
        return lengths - machine.legs.length_mm

    def solve(index: int) -> None:
        start = np.r_[position[index] + 0.1 / np.sqrt(3), 0, 0, 0]
        fsolve(leg_errors, start, args=(vertex + sliders[index][:, None] * direction,), xtol=1e-12)

    return _median_ns(solve, len(position))


def _median_ns(work: Callable[[int], None], count: int) -> float:
    times = []
    for _ in range(REPETITIONS):
        begin = time.perf_counter()
        for index in range(count):
            work(index)
        times.append((time.perf_counter() - begin) / count * 1e9)
    return statistics.median(times)


def processor() -> str:
    """Name the processor and what the engine's dispatch can use of it."""
    text = Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").exists() else ""
    name = next((line.split(":", 1)[1].strip() for line in text.splitlines() if line.startswith("model name")), "")
    flags = next((line.split() for line in text.splitlines() if line.startswith("flags")), [])
    vector = [flag for flag in ("sse2", "avx2", "fma", "avx512f") if flag in flags]
    return f"{name or platform.machine()}, {os.cpu_count()} cores, {' '.join(vector)}"


def table(engine_ns: dict[str, float], scipy_ns: float) -> str:
    """Lay out the page."""
    compiler = subprocess.run(["c++", "--version"], check=True, capture_output=True, text=True).stdout.splitlines()[0]
    lines = [
        "# Benchmarks",
        "",
        f"Machine: {processor()}. Compiler: {compiler}, `-O3` for any x86-64, AVX2 chosen at load time.",
        f"SciPy {scipy.__version__}. Medians of {REPETITIONS} repetitions, both sides in one run; by `make bench`.",
        "Every solution is to 1e-12 mm and allocates nothing.",
        "",
        "| work | time | to reach | against SciPy's fsolve |",
        "|---|---|---|---|",
    ]
    for name, nanoseconds in engine_ns.items():
        target = f"≤ {TARGET_NS[name]} ns" if name in TARGET_NS else ""
        ratio = f"{scipy_ns / nanoseconds:,.0f} times faster" if name.startswith("forward") else ""
        lines.append(f"| {TITLES.get(name, name)} | {nanoseconds:.0f} ns | {target} | {ratio} |")
    lines += [f"| SciPy fsolve, level, start 0.1 mm away | {scipy_ns:,.0f} ns | | 1 |", "", ELSEWHERE]
    return "\n".join(lines)


def main() -> None:
    """Run both sides and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("-o", "--output", type=Path)
    arguments = parser.parse_args()
    print("running the engine's benchmark and SciPy ...", file=sys.stderr)
    page = table(engine_times_ns(arguments.program), scipy_forward_ns())
    if arguments.output:
        arguments.output.write_text(page, encoding="utf-8")
    print(page)


if __name__ == "__main__":
    main()
