"""Processor time of a diagnosis, and of a whole record of a fleet, on one core; beside another checkout's on request.

Usage: diagnosis_times.py [--before CHECKOUT] [--repetitions N]
CHECKOUT is a tree of the project whose engine is built (python/hexdbb/_core*.so). Every repetition runs both sides one
after the other in processes of their own, so that what else the computer does meets both; shown are medians and the
median of the pairs' ratios. Run from the project's root, beside `tests`, which make the fleet's records.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from statistics import median

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.kinematics import inverse
from hexdbb.model import new_model
from hexdbb.plan import load_plan

READINGS = 20_000
NOISE_MM = 0.5e-3
FLEET_RECORDS = 6
REPETITIONS = 5
INNER = 9
"""Times that a process repeats each work; its median counts."""
TARGET_MS = {
    "diagnosis, 20,000 readings × 37 unknowns, with covariance": 10.0,
    "record of a fleet, 20,000 readings": 25.0,
}
ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Problem:
    """Readings of the seven circles, 37 unknowns: geometry, cup and the ball's place along the bar.

    Attributes
    ----------
    engine : Model
    samples : Samples
    measured_mm : ndarray, shape (n,)
    free : ndarray of bool, shape (size,)
    sizes : ndarray, shape (size,)
        Prior standard deviations.
    """

    engine: _core.Model
    samples: _core.Samples
    measured_mm: NDArray[np.float64]
    free: NDArray[np.bool_]
    sizes: NDArray[np.float64]

    def fit(self) -> _core.FitResult:
        """Diagnose from the nominal machine."""
        self.engine.values = np.zeros(len(self.sizes))
        free = [bool(each) for each in self.free]
        return _core.fit(self.engine, self.samples, self.measured_mm, noise_mm=NOISE_MM, free=free)


def problem() -> Problem:
    """Return the problem of the benchmarks."""
    plan = load_plan("standard")
    machine = plan.machine_file()
    angle = np.linspace(0.0, 4.0 * np.pi, READINGS // len(plan.circles))
    tables = [
        inverse(machine, each.poses(angle, plan.mounts[0].cup_mm), each.platform_rpy_rad)[0] for each in plan.circles
    ]
    sliders = np.vstack(tables)
    rows = np.zeros(len(sliders), dtype=np.int32)
    circle = plan.circles[0]
    bar = _core.SetUp(
        cup_mm=np.array(plan.mounts[0].cup_mm), ball_offset_mm=np.array(circle.ball_offset_mm), bar_length_mm=100.0
    )
    samples = _core.Samples(sliders_mm=sliders, set_up=rows, mount=rows, set_ups=[bar])
    model = new_model(machine)
    free = np.array(
        [each.effect not in ("bar_length", "ball_offset") or each.name == "x" for each in model.parameters()]
    )
    free &= np.array([each.effect != "bar_length" for each in model.parameters()])
    sizes = np.array([each.prior_sigma for each in model.parameters()])
    random = np.random.default_rng(20060701)
    engine = model.engine()
    part = np.where([each.is_set_up for each in model.parameters()], 0.1, 0.5)  # of the prior standard deviation
    engine.values = np.where(free, random.normal(size=len(sizes)) * part * sizes, 0.0)
    measured = _core.predict(engine, samples).reading_mm + random.normal(size=len(sliders)) * NOISE_MM
    return Problem(engine, samples, measured, free, sizes)


def measured(folder: Path) -> dict[str, float]:
    """Return the processor time of each work on one core, ms."""
    from hexdbb.fleet.judging import judge

    _core.limit_threads(1)
    posed = problem()
    model = (folder / "model.toml").read_text()
    payloads = [
        {"source": str(path), "files": [str(path)], "command": "diagnose", "model": model}
        for path in sorted((folder / "records").rglob("*.parquet"))
    ]
    judge(payloads[0])  # loads what is loaded once
    names = list(TARGET_MS)
    return {
        names[0]: median(_ms(posed.fit) for _ in range(INNER)),
        names[1]: median(_ms(partial(judge, each)) for each in payloads),
    }


def _ms(work: Callable[[], object]) -> float:
    begin = time.process_time()
    work()
    return (time.process_time() - begin) * 1e3


def _run(tree: Path, folder: Path) -> dict[str, float]:
    environment = {**os.environ, "PYTHONPATH": f"{tree / 'python'}:{tree}"}
    command = [sys.executable, __file__, "--measure", str(folder)]
    found: dict[str, float] = json.loads(
        subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout
    )
    return found


def rows(before: Path | None, repetitions: int) -> list[str]:
    """Return a Markdown table."""
    from tests.fleet.made import Fleet, write_model

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        fleet = Fleet(FLEET_RECORDS, FLEET_RECORDS, "standard")
        for number in range(FLEET_RECORDS):
            fleet.write(folder / "records", number)
        write_model(folder / "model.toml")
        sides = [ROOT] if before is None else [before.resolve(), ROOT]
        found = [[_run(side, folder) for side in sides] for _ in range(repetitions)]
    lines = ["| work, one core | processor time | target | before / now |", "|---|---|---|---|"]
    for work, target in TARGET_MS.items():
        now = median(each[-1][work] for each in found)
        ratio = f"{median(each[0][work] / each[-1][work] for each in found):.2f}" if before else ""
        lines.append(f"| {work} | {now:.1f} ms | ≤ {target:g} ms | {ratio} |")
    return lines


def main() -> None:
    """Print the table, or measure for it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--before", type=Path, metavar="CHECKOUT")
    parser.add_argument("--repetitions", type=int, default=REPETITIONS)
    parser.add_argument("--measure", type=Path, metavar="FOLDER", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.measure:
        print(json.dumps(measured(given.measure)))
    else:
        print("\n".join(rows(given.before, given.repetitions)))


if __name__ == "__main__":
    main()
