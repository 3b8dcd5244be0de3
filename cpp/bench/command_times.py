"""Times of whole commands, from start to end, as a user waits for them; beside another checkout's on request.

Usage: command_times.py [--before CHECKOUT] [--repetitions N] [--only TEXT]
CHECKOUT is a tree of the project whose engine is built, or copied there (python/hexdbb/_core*.so). Every repetition
runs both sides one after the other, so that what else the computer does meets both; shown are medians and the median of
the pairs' ratios.
CPU is user and system time of all threads: on a busy computer it says what the wall time hides.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import numpy as np

import hexdbb as hx
from hexdbb_truth.cases import case
from hexdbb_truth.simulate import Pace

EDITABLE = "ScikitBuildRedirectingFinder"
"""What finds the modules of an editable installation."""
RATES_HZ = {20_000: 11.4, 35_000: 20.0}
"""Samples a second that give about so many readings of the seven circles of the standard plan."""
START = f"""
import pathlib, runpy, sys
tree = pathlib.Path(sys.path[1], "hexdbb")
if any(tree.glob("_core.*.*")):  # else it is installed elsewhere, and found there
    sys.meta_path[:] = [each for each in sys.meta_path if type(each).__name__ != "{EDITABLE}"]
sys.argv[0] = "hexdbb"
runpy.run_module("hexdbb.cli", run_name="__main__")
"""
"""Runs a command of the tree that is first in PYTHONPATH: an editable installation would be found before it."""
FITTED_TO = 8
"""One reading in so many is fitted for the model that commands load: its values only have to be near."""
REPETITIONS = 5


@dataclass(frozen=True)
class Command:
    """One row: a command, the readings it is given, the longest it may take."""

    name: str
    readings: int
    arguments: tuple[str, ...]
    target_s: float


COMMANDS = (
    Command("diagnose", 20_000, ("diagnose", "{record}", "-m", "{new}"), 0.5),
    Command(
        "compare, no pictures, no cause",
        20_000,
        ("compare", "{record}", "-m", "{model}", "--no-plot", "--no-cause"),
        0.8,
    ),
    Command(
        "compare, no pictures, no cause",
        35_000,
        ("compare", "{record}", "-m", "{model}", "--no-plot", "--no-cause"),
        0.8,
    ),
    Command(
        "compare, likely cause and first page",
        20_000,
        ("compare", "{record}", "-m", "{model}", "--plot", "{folder}/c"),
        2.5,
    ),
    Command(
        "compare, likely cause and first page",
        35_000,
        ("compare", "{record}", "-m", "{model}", "--plot", "{folder}/c"),
        2.5,
    ),
    Command(
        "compare, all pages, no cause",
        35_000,
        ("compare", "{record}", "-m", "{model}", "--plot", "{folder}/a", "--pages", "all", "--no-cause"),
        4.0,
    ),
    Command("report", 35_000, ("report", "{record}", "-m", "{model}", "-o", "{folder}/r.html", "--overwrite"), 4.0),
)
"""Rows of the table. All of one machine with a fault that its model lacks: what takes longest."""


@dataclass(frozen=True)
class Side:
    """A checkout of the project, whose commands are timed, and where the bytecode of its modules is kept."""

    tree: Path
    bytecode: Path

    def seconds(self, arguments: list[str]) -> tuple[float, float]:
        """Run a command once; return its wall and CPU time, s."""
        environment = {**os.environ, "PYTHONPATH": str(self.tree / "python"), "PYTHONPYCACHEPREFIX": str(self.bytecode)}
        environment.pop("PYTHONDONTWRITEBYTECODE", None)  # an installed package is not compiled anew at every start
        program = [sys.executable, "-c", START, *arguments]
        begin = time.perf_counter()
        running = subprocess.Popen(program, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        assert running.stderr is not None
        said = running.stderr.read()
        _, status, used = os.wait4(running.pid, 0)
        wall = time.perf_counter() - begin
        if os.waitstatus_to_exitcode(status) != 0:
            raise SystemExit(f"{self.tree}: hexdbb {' '.join(arguments)}: {said.decode().strip()}")
        return wall, used.ru_utime + used.ru_stime


@dataclass(frozen=True)
class Times:
    """Medians of one command, s, and how many times faster it is than before."""

    command: Command
    readings: int
    wall_s: float
    cpu_s: float
    faster: tuple[float, float] | None
    """In wall and CPU time; None where nothing is compared."""


def command_times(before: Path | None = None, repetitions: int = REPETITIONS, only: str = "") -> list[Times]:
    """Time every command whose name contains a text, on records made for it."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        now = Side(Path(__file__).resolve().parents[2], folder / "now")
        old = None if before is None else Side(before.resolve(), folder / "before")
        chosen = [each for each in COMMANDS if only in each.name]
        counts = {each: _prepare(folder, each) for each in sorted({each.readings for each in chosen})}
        return [_timed(each, counts[each.readings], folder, now, old, repetitions) for each in chosen]


def command_rows(times: list[Times]) -> list[str]:
    """Return a Markdown table."""
    compared = any(each.faster for each in times)
    lines = [
        "| command | readings | wall | CPU | target |"
        + (" wall before / now | CPU before / now |" if compared else ""),
        "|---|---|---|---|---|" + ("---|---|" if compared else ""),
    ]
    for each in times:
        row = (
            f"| `hexdbb {each.command.name.split(',')[0]}`{each.command.name.partition(',')[1]}"
            f"{each.command.name.partition(',')[2]} | {each.readings:,} | {each.wall_s:.2f} s | {each.cpu_s:.2f} s |"
            f" ≤ {each.command.target_s:g} s |"
        )
        lines.append(row + (f" {each.faster[0]:.2f} | {each.faster[1]:.2f} |" if each.faster else ""))
    return lines


def _prepare(folder: Path, readings: int) -> int:
    """Write a record, an unfitted and a fitted model; return the number of readings."""
    record = case("backlash-x3-s1", Pace(rate_hz=RATES_HZ[readings], instants_per_sample=4, travel_s=10.0)).record()
    hx.write_record(record, folder / f"{readings}.parquet")
    new = hx.new_model(record.machine)
    hx.save_model(new, folder / f"{readings}-new.toml")
    few = record.part(np.arange(len(record)) % FITTED_TO == 0)
    hx.save_model(hx.diagnose(few, new).model, folder / f"{readings}.toml")
    return len(record)


def _timed(command: Command, readings: int, folder: Path, now: Side, before: Side | None, repetitions: int) -> Times:
    sides = [now] if before is None else [before, now]
    spent: dict[Side, list[tuple[float, float]]] = {side: [] for side in sides}
    for side in sides:
        side.seconds(_arguments(command, folder))  # compiles what it imports
    for _ in range(repetitions):
        for side in sides:
            spent[side].append(side.seconds(_arguments(command, folder)))
    wall, cpu = zip(*spent[now], strict=True)
    faster = None
    if before is not None:
        pairs = zip(spent[before], spent[now], strict=True)
        walls, cpus = zip(*((old[0] / new[0], old[1] / new[1]) for old, new in pairs), strict=True)
        faster = (median(walls), median(cpus))
    return Times(command, readings, median(wall), median(cpu), faster)


def _arguments(command: Command, folder: Path) -> list[str]:
    """Return the command's words; a model that it writes is a fresh copy."""
    new = folder / "new.toml"
    shutil.copyfile(folder / f"{command.readings}-new.toml", new)
    names = {
        "record": folder / f"{command.readings}.parquet",
        "model": folder / f"{command.readings}.toml",
        "new": new,
        "folder": folder,
    }
    return [word.format(**names) for word in command.arguments]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--before", type=Path, metavar="CHECKOUT")
    parser.add_argument("--repetitions", type=int, default=REPETITIONS)
    parser.add_argument("--only", default="", metavar="TEXT", help="commands whose name contains it")
    given = parser.parse_args()
    print("\n".join(command_rows(command_times(given.before, given.repetitions, given.only))))


if __name__ == "__main__":
    main()
