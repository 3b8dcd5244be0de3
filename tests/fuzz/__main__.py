"""Try many damaged inputs over all formats; exit status 1 if a reader fails.

python -m tests.fuzz --count 10000 --seed 1 --failures build/fuzz
"""

from __future__ import annotations

import argparse
import logging
import multiprocessing
import sys
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

from tests.fuzz.formats import FORMATS
from tests.fuzz.inputs import ACCEPTED, FAILED, REFUSED, Outcome, outcome_of, random_input, tidy

BLOCK = 250
"""Inputs of one process: a crash costs no more than the outcomes of one block, which is then named."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--failures", type=Path, default=Path("build/fuzz"), help="folder for inputs that fail")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    options = parser.parse_args(arguments)
    outcomes = tried(options.count, options.seed, options.jobs)
    print(table(outcomes))
    failures = [outcome for outcome in outcomes if outcome.kind == FAILED]
    for number, failure in enumerate(failures):
        options.failures.mkdir(parents=True, exist_ok=True)
        slug = next((each.slug for each in FORMATS if each.name == failure.format), "crash")
        path = options.failures / f"{slug}.{options.seed}-{number}"
        path.write_bytes(failure.data)
        print(f"{path}: {failure.text}")
    return 1 if failures else 0


def tried(count: int, seed: int, jobs: int) -> list[Outcome]:
    """Return the outcomes of many inputs, read in processes of their own."""
    outcomes: list[Outcome] = []
    blocks = [range(begin, min(begin + BLOCK, count)) for begin in range(0, count, BLOCK)]
    with ProcessPoolExecutor(jobs, multiprocessing.get_context("fork")) as pool:
        futures = [pool.submit(block_of_outcomes, block, seed) for block in blocks]
        for block, future in zip(blocks, futures, strict=True):
            try:
                outcomes += future.result()
            except BrokenProcessPool:
                outcomes.append(Outcome(f"inputs {block.start} to {block.stop}", FAILED, "the process crashed"))
    return outcomes


def block_of_outcomes(numbers: range, seed: int) -> list[Outcome]:
    """Return the outcomes of some inputs."""
    logging.disable(logging.CRITICAL)
    try:
        return [outcome_of(*random_input(number, seed)) for number in numbers]
    finally:
        tidy()


def table(outcomes: Sequence[Outcome]) -> str:
    """Return inputs, accepted, refused and failures of each format as a text."""
    counts = Counter((outcome.format, outcome.kind) for outcome in outcomes)
    lines = [f"{'format':<32}{'inputs':>8}{'accepted':>10}{'refused':>9}{'failures':>10}"]
    for name in dict.fromkeys([*(each.name for each in FORMATS), *(outcome.format for outcome in outcomes)]):
        of_kind = [counts[name, kind] for kind in (ACCEPTED, REFUSED, FAILED)]
        lines.append(f"{name:<32}{sum(of_kind):>8}{of_kind[0]:>10}{of_kind[1]:>9}{of_kind[2]:>10}")
    total = [sum(outcome.kind == kind for outcome in outcomes) for kind in (ACCEPTED, REFUSED, FAILED)]
    return "\n".join([*lines, f"{'in all':<32}{sum(total):>8}{total[0]:>10}{total[1]:>9}{total[2]:>10}"])


if __name__ == "__main__":
    sys.exit(main())
