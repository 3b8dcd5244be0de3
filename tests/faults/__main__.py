"""Try every fault and write the page; exit status 1 if a wrong sample was kept or an outcome is not as required.

python -m tests.faults --table docs/fault-table.md --realtime --pairs 40 --seed 1
python -m tests.faults --only "answer twice"
python -m tests.faults --kills 100 --seed 1
python -m tests.faults --soak 50 --table docs/soak.md
python -m tests.faults --cycles 1000000
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from tests.faults.catalogue import FAULTS
from tests.faults.memory import memory_of
from tests.faults.page import page, summary
from tests.faults.soak import report
from tests.faults.tasks import Task, killed, made

from hexdbb.files.atomic_file import write_text


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line."""
    options = _options(arguments)
    if options.soak:
        return 1 if report(options.soak, options.table) else 0
    if options.cycles:
        for cycles, megabytes in memory_of(options.cycles):
            print(f"{cycles} cycles: {megabytes:.1f} MB", flush=True)
        return 0
    if options.kills:
        kills = killed(options.kills, options.seed, options.jobs)
        failed = sum(bool(each.unmet) for each in kills)
        print(f"{len(kills)} kills, {sum(each.wrong for each in kills)} wrong samples, {failed} not as required")
        return 1 if failed else 0
    names = options.only or [fault.name for fault in FAULTS]
    paces = [True, False] if options.realtime else [True]
    tasks = [Task(name, 0, pace, options.seed) for pace in paces for name in names]
    tasks += [Task(None, number, True, options.seed) for number in range(options.pairs)]
    trials = made(tasks, options.jobs)
    print(summary(trials))
    if options.table is not None:
        single = [trial for trial, task in zip(trials, tasks, strict=True) if task.name is not None]
        said = f"{' --realtime' if options.realtime else ''} --pairs {options.pairs} --seed {options.seed}"
        write_text(options.table, page(single, trials[len(single) :], said))
    return 1 if any(trial.unmet for trial in trials) else 0


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.faults", description=__doc__.splitlines()[0])
    parser.add_argument("--table", type=Path, help="page to write")
    parser.add_argument("--only", action="append", metavar="NAME", help="a fault to try; may be repeated")
    parser.add_argument("--pairs", type=int, default=0, help="random pairs of faults, in lockstep")
    parser.add_argument("--kills", type=int, default=0, help="instead: runs killed at random moments")
    parser.add_argument("--soak", type=int, default=0, help="instead: runs in real time without a fault, under load")
    parser.add_argument("--cycles", type=int, default=0, help="instead: memory of so many cycles in lockstep")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--realtime", action="store_true", help="in real time as well")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    return parser.parse_args(arguments)


if __name__ == "__main__":
    sys.exit(main())
