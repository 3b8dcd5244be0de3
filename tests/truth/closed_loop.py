"""Does compensation hold on held-out circles? Loops closed on machines of known truth, and the page that reports them.

python -m tests.truth.closed_loop -o docs/closed-loop.md
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from tests.truth.closed_loop_picture import draw
from tests.truth.closing import MAX_CORRECTION_MM, CircleError, Loop, close
from tests.truth.held_out import BARS_MM, FEED_MM_MIN, held_out_plans

from hexdbb.plan import load_plan

PLAN = "docs/plans/best-7.toml"
SHIPPED_PLAN = "standard"
SEEDS, SHIPPED_SEEDS = 5, 2
ROUNDS = 2
RMS_REDUCTION, PEAK_REDUCTION, NOISE_RATIO = 50.0, 20.0, 1.5
"""Target: RMS and peak-to-valley error fall by these factors, or to `NOISE_RATIO` times the gauge noise where that is
larger, below which one circle cannot show an error."""
PICTURE = "images/closed-loop.png"
PICTURED_CIRCLE = 10

Value = Callable[[CircleError], float]


def rms_um(errors: Sequence[CircleError]) -> float:
    """Return the RMS over all samples of some circles, µm."""
    return float(np.sqrt(np.mean(np.concatenate([each.radial_um for each in errors]) ** 2)))


def peak_um(errors: Sequence[CircleError]) -> float:
    """Return the peak to valley of the worst circle, µm."""
    return max(each.peak_to_valley_um for each in errors)


def circles_on_target(loop: Loop, number: int, value: Value, reduction: float) -> int:
    """Return the number of held-out circles that reach the target after a round."""
    after = loop.rounds[number].after
    return sum(
        value(now) <= max(value(before) / reduction, NOISE_RATIO * value(noise))
        for before, now, noise in zip(loop.before, after, loop.noise, strict=True)
    )


PAGE = """\
# The loop closed: compensation on held-out circles

A machine is measured and diagnosed, the missing effects are discovered, the model becomes a compensation file, and
circles at other heights and places, with other tilts, radii and feed, are driven with it. The commands of a user:
```
hexdbb-run --plan best-7.toml -o before.parquet
hexdbb diagnose before.parquet -m model.toml
hexdbb discover before.parquet -m model.toml --auto
hexdbb compensate model.toml --max-correction-um {most_um:g} -o sp120.hexcomp
hexdbb-run --plan held-out.toml --compensation sp120.hexcomp -o after.parquet
hexdbb compare after.parquet -m model.toml
```
The machines are those of the [truth simulator](../python/hexdbb_truth), which shares no code with the engine: errors of
geometry of 50 µm and 0.2 mrad, cup and ball misplaced by 0.1 and 0.03 mm, in every drive play of 5 to 20 µm and a
pitch error of 2 to 6 µm (second harmonic 0.5 to 2 µm), legs with a compliance of 0.4 µm/N; gauge noise 0.5 µm. Fitted:
[best-7](plans/best-7.toml), seven circles about one cup, one radius of 100 mm. Held out: {circles} circles, each about
a cup of its own, bars of {bars} mm, {feed:g} mm/min, planes tilted up to 20°, platform up to 15° and yawed
up to 20°, within the clearances that `plan propose` requires.

![A held-out circle before and after]({picture})

*One held-out circle of 100 mm, both directions, on machine {first_seed}.*

**The measure** is the radial error as `hexdbb compare` defines it: the deviation of each sample from a perfect circle
of the commanded radius. The position of the cup of a held-out circle is unknown, so its offset in the circle's plane is
determined by least squares and removed, before and after alike, as ISO 230-4 removes a centre; the radius is not.
Nothing else is removed.

## After one round

| machine | before, µm | after, µm | gauge alone, µm | machine alone, µm | its reduction | on target | effects added |
|---|---|---|---|---|---|---|---|
{rows}

RMS over all held-out circles / peak to valley of the worst. *Gauge alone*: perfect circles with the gauge noise.
*Machine alone*: the same circles in a perfect set-up, with a gauge without noise and cups in their nominal positions.
*Its reduction*: of RMS / peak to valley, before over machine alone. *On target*: circles whose RMS has fallen by a
factor of {rms_reduction:g}, and those whose peak to valley has by {peak_reduction:g}, or to {noise_ratio:g} times
the value of the gauge alone.
A cup out of a circle's plane by z enlarges its radius by z²/2R, by 0.75 µm for 0.3 mm and a bar of 60 mm: the readings
of one circle cannot separate that from the machine, so it counts as an error here. *Effects added*: by
`discover --auto`. Its last verdict was {verdict}

## Compensated repeatedly

The fitted circles are driven again, compensated, and both records are diagnosed together (`diagnose --robust`):

| machine | after one round, µm | after two, µm | machine alone, one round, µm | two, µm |
|---|---|---|---|---|
{second_rows}

The fit is nonlinear and uses the measured slider positions, so the first round leaves almost nothing of what the model
can describe: a second one adds readings, not another step of an iteration. It serves a machine that has changed, or
circles that the first plan did not contain.

Discovery does not use compensated records of few samples per second: while a drive crosses its play at a reversal,
within some hundredths of a second, such a record does not determine the direction of travel, which resembles a spike at
the reversal.

## With the shipped plan

The same with `standard`, seven level circles about one cup:

| machine | before, µm | after, µm | gauge alone, µm | machine alone, µm | its reduction | on target | effects added |
|---|---|---|---|---|---|---|---|
{shipped_rows}

Either plan suffices once nothing is missing from the model. Before that neither does: what a model cannot describe is
attributed to combinations of errors that the plan hardly determines, and appears enlarged on circles elsewhere.
Diagnosed with geometry alone, machine 1 needed corrections of more than a millimetre there, and was refused
(`--max-correction-um`). Therefore: `discover` until nothing is missing, then compensate.

Where the catalogue does not have the fault:
[The loop closed where an effect had to be learned](closed-loop-learned.md).

Made by `{command}` in {minutes:.0f} minutes.
"""


def row(loop: Loop) -> str:
    """Return the row of one machine after its first round."""
    found = ", ".join(loop.found.added) or "nothing"
    found += "" if loop.found.is_complete else "; something is still missing"
    if not loop.rounds:
        return f"| {loop.seed} | {_pair(loop.before, 1)} | refused: {loop.refused} | | | | | {found} |"
    once, circles = loop.rounds[0], len(loop.before)
    reductions = (rms_um(loop.before) / rms_um(once.machine_alone), peak_um(loop.before) / peak_um(once.machine_alone))
    on_target = (
        circles_on_target(loop, 0, _rms, RMS_REDUCTION),
        circles_on_target(loop, 0, _peak, PEAK_REDUCTION),
    )
    cells = (
        str(loop.seed),
        _pair(loop.before, 1),
        _pair(once.after, 2),
        _pair(loop.noise, 2),
        _pair(once.machine_alone, 2),
        f"{reductions[0]:.0f} / {reductions[1]:.0f}",
        f"{', '.join(map(str, on_target))} of {circles}",
        found,
    )
    return f"| {' | '.join(cells)} |"


def second_row(loop: Loop) -> str:
    """Return the row of one machine after both rounds."""
    cells = [str(loop.seed), *(_pair(each.after, 2) for each in loop.rounds)]
    return f"| {' | '.join([*cells, *(_pair(each.machine_alone, 2) for each in loop.rounds)])} |"


def page(loops: Sequence[Loop], shipped: Sequence[Loop], command: str, minutes: float) -> str:
    """Return the page as Markdown."""
    is_complete = all(loop.found.is_complete for loop in loops)
    return PAGE.format(
        circles=sum(len(plan.circles) for plan in held_out_plans()),
        bars=", ".join(f"{each:g}" for each in BARS_MM),
        feed=FEED_MM_MIN,
        most_um=1e3 * MAX_CORRECTION_MM,
        picture=PICTURE,
        first_seed=loops[0].seed,
        rows="\n".join(map(row, loops)),
        rms_reduction=RMS_REDUCTION,
        peak_reduction=PEAK_REDUCTION,
        noise_ratio=NOISE_RATIO,
        verdict="always that nothing is missing."
        if is_complete
        else "that nothing is missing, unless the table says otherwise.",
        second_rows="\n".join(map(second_row, loops)),
        shipped_rows="\n".join(map(row, shipped)),
        command=command,
        minutes=minutes,
    )


def _rms(error: CircleError) -> float:
    return error.rms_um


def _peak(error: CircleError) -> float:
    return error.peak_to_valley_um


def _pair(errors: Sequence[CircleError], digits: int) -> str:
    return f"{rms_um(errors):.{digits}f} / {peak_um(errors):.1f}"


def closed(plan_name: str, seeds: int, rounds: int) -> list[Loop]:
    """Close a loop on each machine and report progress on stderr."""
    loops, begin, width = [], time.monotonic(), 0
    for seed in range(1, seeds + 1):

        def report_step(step: str, seed: int = seed) -> None:
            nonlocal width
            line = f"{plan_name}: machine {seed} of {seeds}, {time.monotonic() - begin:.0f} s: {step}"
            print(f"\r{line:<{width}}", end="", file=sys.stderr, flush=True)
            width = len(line)

        loops.append(close(seed, load_plan(plan_name), rounds, report_step))
        print(file=sys.stderr)
        print(row(loops[-1]), file=sys.stderr)
    return loops


def main() -> None:
    """Run the study and write page and picture."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=SEEDS)
    parser.add_argument("--shipped-seeds", type=int, default=SHIPPED_SEEDS)
    parser.add_argument("-o", "--output", type=Path)
    arguments = parser.parse_args()
    begin, command = time.monotonic(), "python -m tests.truth.closed_loop -o docs/closed-loop.md"
    loops = closed(PLAN, arguments.seeds, ROUNDS)
    shipped = closed(SHIPPED_PLAN, arguments.shipped_seeds, 1)
    text = page(loops, shipped, command, (time.monotonic() - begin) / 60.0)
    if arguments.output:
        arguments.output.write_text(text, encoding="utf-8")
        pair = (loops[0].before[PICTURED_CIRCLE], loops[0].rounds[0].after[PICTURED_CIRCLE])
        draw(*pair, "A held-out circle: radial error", arguments.output.parent / PICTURE)
    print(text)


if __name__ == "__main__":
    main()
