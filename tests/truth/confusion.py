"""How often is the verdict right? Discovery tried on machines whose faults are known, and the table that says so.

Every effect of the catalogue alone, at several sizes; pairs; machines without a fault; faults the catalogue does not
have. A verdict counts as right where it names the hidden effect first or among those it cannot tell apart (of a pair:
either), `none` where nothing is hidden, `unknown` where the fault is outside the catalogue. Legs 1 and 2 of a joint,
and so on, are one to first order. Of a pair discovery goes on until nothing is missing; whether both were found is
counted apart.

    python -m tests.truth.confusion --seeds 20 -o docs/discovery-trials.md
"""

from __future__ import annotations

import argparse
import itertools
import json
import sys
import time
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
from tests.truth.cases import Case, alone, case, clean, outside, pairs

from hexdbb.discovery import AutoStep, Discovery, discover, discover_all
from hexdbb.errors import HexdbbError
from hexdbb.model import new_model
from hexdbb.samples import Samples

CLEAN_PER_SEED = 10
PAIRS_PER_SEED = 3
HELD_OUT = 1.2
"""Error on readings left out of the fit, over the noise, that counts as predicted."""


@dataclass(frozen=True)
class Outcome:
    """One case and what was said of it."""

    name: str
    kinds: tuple[str, ...]
    times_noise: float
    verdict: str
    named: str
    is_right: bool
    is_element_right: bool | None
    rms_before_um: float
    held_over_noise: float | None
    seconds: float
    is_all_found: bool | None = None

    @property
    def is_held_out(self) -> bool | None:
        """Whether readings left out of the fit are predicted to the noise."""
        return None if self.held_over_noise is None else self.held_over_noise < HELD_OUT


def tried(one: Case) -> Outcome:
    """Measure a case and judge the verdict."""
    record = one.record()
    begin = time.perf_counter()
    found = discover(Samples.of([record]), new_model(record.machine))
    seconds = time.perf_counter() - begin
    best = found.best
    named = best.effect if best is not None else ""
    held = None if found.heldout_after_um is None else found.heldout_after_um / found.lack_of_fit.noise_um
    return Outcome(
        name=one.name,
        kinds=one.kinds,
        times_noise=one.times_noise,
        verdict=found.verdict,
        named=named,
        is_right=_is_right(one, found),
        is_element_right=_element_right(one, found),
        rms_before_um=found.rms_before_um,
        held_over_noise=held if best is not None else None,
        seconds=seconds,
    )


def tried_to_the_end(one: Case) -> Outcome:
    """Measure a case of several faults, judge the first verdict, and see what was found in the end."""
    first = tried(one)
    record = one.record()
    steps = [
        step for step in discover_all(Samples.of([record]), new_model(record.machine)) if isinstance(step, AutoStep)
    ]
    found = {choice.split(":")[0] for choice in (step.choice for step in steps if step.what == "add")}
    found -= {step.choice.split(":")[0] for step in steps if step.what == "remove"}
    held = steps[-1].diagnosis.held_out if steps else None
    return replace(
        first,
        is_all_found=found == set(one.kinds),
        held_over_noise=None if held is None else held.after_um / (steps[-1].diagnosis.noise.sigma_mm * 1e3),
    )


def _is_right(one: Case, found: Discovery) -> bool:
    if not one.kinds:
        return found.verdict == "none"
    if not one.catalogued:
        return found.verdict == "unknown"
    named = {found.best.effect, *(each.partition(":")[0] for each in found.ambiguous_with)} if found.best is not None else set()
    return bool(named & set(one.kinds))


def _element_right(one: Case, found: Discovery) -> bool | None:
    best = found.best
    if best is None:
        return None
    wanted = {hidden.element for hidden in one.hidden if hidden.kind == best.effect} - {None}
    if not wanted:
        return None
    same = (lambda element: (int(element) + 1) // 2) if best.effect == "joint_offset" else int
    return {same(each) for each in best.elements} == {same(each) for each in wanted}


def cases(seeds: int) -> Iterator[Case]:
    """Give the cases of a study."""
    numbers = range(seeds)
    two = pairs()
    for seed in numbers:
        yield from clean(range(CLEAN_PER_SEED * seed, CLEAN_PER_SEED * (seed + 1)))
        yield from alone(seeds=[seed])
        yield from outside(seeds=[seed])
        yield from itertools.islice(two, PAIRS_PER_SEED)


PAGE = """\
# Trials of discovery

Machines with random errors of geometry (50 µm, 0.2 mrad), of the set-up and gauge noise of 0.5 µm, and one hidden
fault (or two, or none), driven through the seven standard circles, both ways at two feeds; the truth simulator shares
no code with the estimator and steps mechanisms through time. Sizes are what a fault leaves in the readings beyond
what geometry and set-up can absorb, in multiples of the noise. {count} cases, {seeds} seeds each. Of two faults
discovery goes on (`--auto`) until nothing is missing; held-out errors are those at the end.

| | at 1 × noise | at 3 × and more |
|---|---|---|
{summary}

Discovery takes {seconds:.1f} s (median) on these records.

| hidden | cases at 3 × and more | right | right element | called | held-out RMS over noise, median |
|---|---|---|---|---|---|
{rows}

Made by `{command}`.
"""


def page(outcomes: list[Outcome], seeds: int, command: str) -> str:
    """Lay out the page."""
    groups: dict[str, list[Outcome]] = defaultdict(list)
    for each in outcomes:
        groups[_group(each)].append(each)
    rows = []
    for group, members in groups.items():
        large = [each for each in members if each.times_noise >= 3.0 or not each.kinds]
        if not large:
            continue
        called = Counter(each.named or each.verdict for each in large).most_common(3)
        held = [each.held_over_noise for each in large if each.held_over_noise is not None]
        rows.append(
            f"| {group} | {len(large)} | {_share(each.is_right for each in large)}"
            f" | {_share(each.is_element_right for each in large if each.is_element_right is not None)}"
            f" | {', '.join(f'{name} {count}' for name, count in called)}"
            f" | {f'{np.median(held):.2f}' if held else ''} |"
        )
    return PAGE.format(
        count=len(outcomes),
        seeds=seeds,
        summary=_summary(outcomes),
        seconds=float(np.median([each.seconds for each in outcomes])),
        rows="\n".join(rows),
        command=command,
    )


def _group(outcome: Outcome) -> str:
    if not outcome.kinds:
        return "nothing"
    return "two effects" if len(outcome.kinds) > 1 else outcome.kinds[0]


def _summary(outcomes: list[Outcome]) -> str:
    known = [each for each in outcomes if each.kinds and case(each.name).catalogued]
    strange = [each for each in outcomes if each.kinds and not case(each.name).catalogued]
    clean_ones = [each for each in outcomes if not each.kinds]

    def line(title: str, members: list[Outcome], what: str) -> str:
        cells = []
        for large in (False, True):
            chosen = [each for each in members if (each.times_noise >= 3.0) == large]
            values = [getattr(each, what) for each in chosen]
            cells.append(_share(value for value in values if value is not None))
        return f"| {title} | {cells[0]} | {cells[1]} |"

    return "\n".join(
        [
            line("right effect first or in the named set", known, "is_right"),
            line("right element", known, "is_element_right"),
            line("fault outside the catalogue called unknown", strange, "is_right"),
            line("both of two effects found, one after the other, and nothing else", known, "is_all_found"),
            f"| clean machines called clean | {_share(each.is_right for each in clean_ones)} | |",
            line(f"held-out RMS within {HELD_OUT:g} × the noise once added", known, "is_held_out"),
        ]
    )


def _share(values: Iterator[bool | None]) -> str:
    listed = [bool(each) for each in values]
    return f"{np.mean(listed):.1%} of {len(listed)}" if listed else ""


def main() -> None:
    """Run the study and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument(
        "--log", type=Path, help="Append every outcome here as a line of JSON; cases in it are not run."
    )
    parser.add_argument("-o", "--output", type=Path)
    arguments = parser.parse_args()
    done: dict[str, Outcome] = {}
    if arguments.log is not None and arguments.log.exists():
        for line in arguments.log.read_text().splitlines():
            fields = json.loads(line)
            done[fields["name"]] = Outcome(**{**fields, "kinds": tuple(fields["kinds"])})
    outcomes = []
    for one in cases(arguments.seeds):
        outcome = done.get(one.name)
        if outcome is None:
            try:
                outcome = tried_to_the_end(one) if len(one.kinds) > 1 else tried(one)
            except (HexdbbError, ValueError) as error:
                print(f"{one.name}: {error}", file=sys.stderr)
                continue
            if arguments.log is not None:
                with arguments.log.open("a") as log:
                    log.write(json.dumps(asdict(outcome)) + "\n")
        outcomes.append(outcome)
        mark = "" if outcome.is_right else f"  WRONG: {outcome.verdict} {outcome.named}"
        print(f"{len(outcomes)} {one.name} {outcome.seconds:.1f} s{mark}", file=sys.stderr, flush=True)
    text = page(outcomes, arguments.seeds, f"python -m tests.truth.confusion --seeds {arguments.seeds}")
    if arguments.output:
        arguments.output.write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
