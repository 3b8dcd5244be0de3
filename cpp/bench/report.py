"""Run the engine's benchmark, SciPy on the same tasks, whole discoveries and commands; write docs/benchmarks.md.

Usage: report.py BENCHMARK_PROGRAM [-o docs/benchmarks.md]
Times are medians of repetitions on a machine that may be busy: compare ratios.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import scipy
from command_times import command_rows, command_times
from diagnosis_times import NOISE_MM, problem
from discovery_times import HEADER as DISCOVERY_HEADER
from discovery_times import PACE, discovery_rows
from growth import HEADER, LARGEST_MB, TIMES_DRIVEN, growth_rows
from measured_by import compiler, median_rows, processor, report
from numpy.typing import NDArray
from scipy.optimize import fsolve, least_squares

from hexdbb import _core
from hexdbb.kinematics import engine_machine, inverse
from hexdbb.machine import shipped_machine
from hexdbb_truth.cases import case

REPETITIONS = 9
TARGET_NS = {
    "inverse_pose": 25,
    "forward_warm/level": 150,
    "forward_warm/tilted": 150,
    "forward_home/level": 250,
    "forward_home/tilted": 250,
    "batch/reading": 30,
}
TITLES = {
    "inverse_pose": "inverse kinematics, one pose",
    "forward_warm/level": "forward (RSSR), level, start 0.1 mm away",
    "forward_warm/tilted": "forward (RSSR), tilted to 8.6°, start 0.1 mm away",
    "forward_home/level": "forward (RSSR), level, from home",
    "forward_home/tilted": "forward (RSSR), tilted, from home",
    "forward_six_warm": "forward (six coordinates), start 0.1 mm away",
    "batch/reading": "forward and reading in batch, per pose and core",
    "batch/sensitivity": "the same with the derivative at all 55 ports",
    "sensitivity": "reading's derivative at all 55 ports (RSSR)",
    "sensitivity_six": "reading's derivative at all 55 ports (6×6)",
}
ELSEWHERE = """\
Measured elsewhere, on two shared cores of an EPYC with g++ 12 `-O3 -march=native` (quoted, not run here): LinuxCNC's
genhexkins forward 1455-1715 ns level and 4400-5200 ns tilted, inverse 195-240 ns; Pinocchio's loop 7400 ns.
"""


def engine_times_ns(program: Path) -> dict[str, float]:
    """Return the median CPU time of each benchmark of the C++ program, ns."""
    return {
        name: row["cpu_time"] / (row["cpu_time"] * 1e-9 * row["items_per_second"] if "items_per_second" in row else 1)
        for name, row in median_rows(program, REPETITIONS).items()
    }


def scipy_forward_ns() -> float:
    """Return the time of forward kinematics by scipy.optimize.fsolve on the leg lengths, from 0.1 mm away, to 1e-12."""
    machine = shipped_machine()
    engine = engine_machine(machine)
    vertex = np.array([_core.guideway_vertex(engine, k // 2) for k in range(6)])
    direction = np.array([_core.guideway_direction(engine, k // 2) for k in range(6)])
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


def diagnosis_times_ms() -> dict[str, float]:
    """Return the times of diagnosis, ms: the engine's, and SciPy's least_squares on the engine's predictions."""
    posed = problem()
    engine, samples, measured, free, sizes = posed.engine, posed.samples, posed.measured_mm, posed.free, posed.sizes

    def residuals(z: np.ndarray) -> np.ndarray:
        values = np.zeros(len(sizes))
        values[free] = z * sizes[free]
        engine.values = values
        return np.concatenate([(_core.predict(engine, samples).reading_mm - measured) / NOISE_MM, z])

    def jacobian(z: np.ndarray) -> np.ndarray:
        values = np.zeros(len(sizes))
        values[free] = z * sizes[free]
        engine.values = values
        seen = _core.predict(engine, samples, want_jacobian=True).jacobian[:, free] * (sizes[free] / NOISE_MM)
        return np.vstack([seen, np.eye(free.sum())])

    start = np.zeros(free.sum())
    return {
        f"diagnosis, {len(measured):,} readings, {free.sum()} unknowns, coarse to fine": _median_ns(
            lambda _: posed.fit(), 1
        )
        / 1e6,
        "the same, SciPy least_squares, the engine's predictions and Jacobian": _median_ns(
            lambda _: least_squares(residuals, start, jacobian, x_scale="jac"), 1, 3
        )
        / 1e6,
        "the same, SciPy least_squares, finite differences": _median_ns(
            lambda _: least_squares(residuals, start, x_scale="jac"), 1, 1
        )
        / 1e6,
    }


def _median_ns(work: Callable[[int], object], count: int, repetitions: int = REPETITIONS) -> float:
    times = []
    for _ in range(repetitions):
        begin = time.perf_counter()
        for index in range(count):
            work(index)
        times.append((time.perf_counter() - begin) / count * 1e9)
    return statistics.median(times)


def table(
    engine_ns: dict[str, float],
    scipy_ns: float,
    diagnosis_ms: dict[str, float],
    discoveries: list[str],
    commands: list[str],
    growth: list[str],
) -> str:
    """Return the page as Markdown."""
    lines = [
        "# Benchmarks",
        "",
        f"Machine: {processor()}. Compiler: {compiler()}, `-O3` for any x86-64, AVX2 chosen at load time.",
        f"SciPy {scipy.__version__}. Medians of {REPETITIONS} repetitions, both sides in one run; by `make bench`.",
        "Every solution is to 1e-12 mm and allocates nothing.",
        "",
        "| work | time | target | against SciPy's fsolve |",
        "|---|---|---|---|",
    ]
    for name, nanoseconds in engine_ns.items():
        target = f"≤ {TARGET_NS[name]} ns" if name in TARGET_NS else ""
        ratio = f"{scipy_ns / nanoseconds:,.0f} times faster" if name.startswith("forward") else ""
        lines.append(f"| {TITLES.get(name, name)} | {nanoseconds:.0f} ns | {target} | {ratio} |")
    lines += [f"| SciPy fsolve, level, start 0.1 mm away | {scipy_ns:,.0f} ns | | 1 |", ""]
    ours, *_ = diagnosis_ms.values()
    lines += ["| work | time | target | ratio to the first |", "|---|---|---|---|"]
    for name, milliseconds in diagnosis_ms.items():
        target = "≤ 10 ms" if milliseconds is ours else ""
        lines.append(f"| {name} | {milliseconds:,.0f} ms | {target} | {milliseconds / ours:,.1f} |")
    lines += [
        "",
        "One call of `discover`: known effects and learned functions screened, the best fitted and judged.",
        "",
        *DISCOVERY_HEADER,
        *discoveries,
        "",
        "Whole commands from start to end, as a user waits for them; CPU is that of all threads. Beside another",
        "checkout: `python cpp/bench/command_times.py --before CHECKOUT`.",
        "",
        *commands,
        "",
        f"Growth: processor time of `Samples.of` and `diagnose` on one plan driven {_listed(TIMES_DRIVEN)} times,"
        f" each in a process of its own. Limit of memory: {LARGEST_MB:,} MB.",
        "",
        *HEADER,
        *growth,
        "",
        ELSEWHERE,
    ]
    return "\n".join(lines)


def _listed(numbers: Sequence[int]) -> str:
    *others, last = map(str, numbers)
    return f"{', '.join(others)} and {last}"


def page(program: Path) -> str:
    """Run both sides and return the page as Markdown."""
    return table(
        engine_times_ns(program),
        scipy_forward_ns(),
        diagnosis_times_ms(),
        discovery_rows(),
        command_rows(command_times()),
        growth_rows(case("none-s1", PACE).record()),
    )


if __name__ == "__main__":
    report(__doc__, "the engine's benchmark and SciPy", page)
