"""Does compensation hold where an effect had to be learned? Loops closed on machines with forms, and their page.

python -m tests.truth.learned_loop -o docs/closed-loop-learned.md

Every machine is a file of the folder of results; one that is there is not closed again, so that a run can be
interrupted, and two share the work.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from functools import partial
from pathlib import Path

import numpy as np
from tests.truth.held_out import BARS_MM, FEED_MM_MIN, held_out_plans
from tests.truth.learned_closing import MAX_CORRECTION_MM, TIMES_NOISE, Closed, case_of, close
from tests.truth.spread_plan import CUPS_MM, FEEDS_MM_MIN, spread_plan

from hexdbb_truth.forms.sizes import UnreachableSizeError

SEEDS = 20
"""Every pair of the four known and five other faults once."""
DEVIATION = 0.1
"""Part of the known fault's push that is not the catalogue's formula: the middle of the calibration's 0 to 20 %."""
TARGET = 50.0
"""Times by which the machine's own error is to fall."""

PAGE = """\
# The loop closed where an effect had to be learned

As [The loop closed](closed-loop.md), on machines that the catalogue does not describe: one known fault whose form is
{deviation:.0%} off the catalogue's, and one fault outside the catalogue, each leaving {times:g} times the noise when
geometry has been fitted. The truth simulator (`hexdbb_truth.forms`) shares neither code nor forms with the estimator.
Measured: [spread-24](plans/spread-24.toml), {fitted} circles about {cups} cups at {feeds} mm/min, spread over the
space that is to be compensated. Held out: {held_out} circles, each about a cup of its own, bars of {bars} mm,
at {held_feed:g} mm/min. The commands of a user:
```
hexdbb-run --plan spread-24.toml -o before.parquet
hexdbb diagnose before.parquet -m model.toml
hexdbb discover before.parquet -m model.toml
hexdbb add EFFECT before.parquet -m model.toml
hexdbb compensate model.toml --max-correction-um {most_um:g} -o sp120.hexcomp
hexdbb-run --plan held-out.toml --compensation sp120.hexcomp -o after.parquet
```
`discover` and `add` are repeated until nothing more is found: every cause is added, and of what refines a form that
which predicts circles left out better, as `add` prints it.

**The machine's own error on held-out circles falls {median:.0f} times in the median of {count} machines,
{worst:.0f} times in the worst case; {reached} of {count} reach {target:g} times.**

| machine | added | last verdict | before, µm | after, µm | times smaller | model, µm | faults known, µm |
|---|---|---|---|---|---|---|---|
{rows}

*Before*, *after*: radial error of the held-out circles in a perfect set-up with a gauge without noise, RMS, as
[The loop closed](closed-loop.md) measures the machine alone. *Model*: what the model misses of the same circles, not
compensated: what a controller would leave that corrects all of it; more where a fault of the machine is put at the
ball, which no controller moves. *Faults known*: after, if the faults were known
exactly and only geometry were fitted to the same noisy readings.

Noise, plan and geometry set a limit of {known_ratio:.0f} times in the median. The models found would reach
{model_ratio:.0f} times in the median: what they miss is the forms of the faults, where functions describe them
incompletely. A controller loses the rest: directions of travel change over within some travel, and effects in brackets
are in the model and [not corrected](compensation.md), because they depend on what a controller does not know (the time
since a reversal) or push the ball; that is so on {uncorrected} of the machines.
{skipped}
Made by `{command}`.
"""


def page(closed: Sequence[Closed], skipped: Sequence[int], command: str) -> str:
    """Return the page as Markdown."""
    ratios = [each.ratio if np.isfinite(each.ratio) else 0.0 for each in closed]
    return PAGE.format(
        deviation=DEVIATION,
        times=TIMES_NOISE,
        fitted=len(spread_plan().circles),
        cups=len(CUPS_MM),
        feeds=" and ".join(f"{each:g}" for each in FEEDS_MM_MIN),
        held_out=sum(len(plan.circles) for plan in held_out_plans()),
        bars=", ".join(f"{each:g}" for each in BARS_MM),
        held_feed=FEED_MM_MIN,
        most_um=1e3 * MAX_CORRECTION_MM,
        count=len(closed),
        median=float(np.median(ratios)),
        worst=min(ratios),
        reached=sum(each >= TARGET for each in ratios),
        target=TARGET,
        rows="\n".join(map(row, closed)),
        known_ratio=float(np.median([each.before_um / each.known_um for each in closed])),
        model_ratio=float(np.median([each.before_um / each.model_um for each in closed])),
        uncorrected=sum(bool(each.left_out) for each in closed),
        skipped=_skipped(skipped),
        command=command,
    )


def row(one: Closed) -> str:
    """Return the row of one machine."""
    cells = (
        one.case,
        ", ".join(f"({each})" if each in one.left_out else each for each in one.added) or "nothing",
        one.verdict,
        f"{one.before_um:.2f}",
        f"{one.after_um:.3f}",
        f"{one.ratio:.0f}" if np.isfinite(one.ratio) else "refused",
        f"{one.model_um:.3f}",
        f"{one.known_um:.3f}",
    )
    return f"| {' | '.join(cells)} |"


def _skipped(seeds: Sequence[int]) -> str:
    if not seeds:
        return ""
    return f"Left out, because no machine in use has a fault so large: seed {', '.join(map(str, seeds))}.\n"


def closed_or_kept(results: Path, half: str, seed: int) -> Closed | None:
    """Return one machine's loop, from the folder of results where it is there; None where no fault is so large."""
    path = results / f"{half}-{seed}.json"
    if not path.exists():
        try:
            found = asdict(close(case_of(seed, DEVIATION, half)))
        except UnreachableSizeError:
            found = None
        path.write_text(json.dumps(found), encoding="utf-8")
    kept = json.loads(path.read_text(encoding="utf-8"))
    return None if kept is None else Closed(**{**kept, **{key: tuple(kept[key]) for key in ("added", "left_out")}})


def all_closed(results: Path, half: str, seeds: Sequence[int], workers: int) -> Iterator[tuple[int, Closed | None]]:
    """Yield seeds and their loops, in order, and report each on stderr."""
    results.mkdir(parents=True, exist_ok=True)
    with ProcessPoolExecutor(workers) as pool:
        for seed, one in zip(seeds, pool.map(partial(closed_or_kept, results, half), seeds), strict=True):
            print(f"seed {seed}: " + ("no fault so large" if one is None else row(one)), file=sys.stderr, flush=True)
            yield seed, one


def main() -> None:
    """Close the loops and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=SEEDS, help="how many machines")
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--half", choices=("calibrate", "judge"), default="judge", help="half of the forms")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--results", type=Path, default=Path("build/learned-loop"), help="a file for each machine")
    parser.add_argument("-o", "--output", type=Path)
    asked = parser.parse_args()
    seeds = range(asked.first, asked.first + asked.seeds)
    loops = list(all_closed(asked.results, asked.half, seeds, asked.workers))
    command = "python -m tests.truth.learned_loop" + (f" --seeds {asked.seeds}" if asked.seeds != SEEDS else "")
    command += (f" --first {asked.first}" if asked.first else "") + " -o docs/closed-loop-learned.md"
    text = page([one for _, one in loops if one is not None], [seed for seed, one in loops if one is None], command)
    if asked.output:
        asked.output.write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
