"""What to measure or do next, by what a test lacks: the first step is the one that the others wait for."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from hexdbb.comparison import Comparison
from hexdbb.diagnosis import Sufficiency
from hexdbb.identifiability import observability, plan_sensitivity
from hexdbb.model import Model
from hexdbb.plan import load_plan
from hexdbb.samples import Samples

FULL_PLAN = "standard"
"""Shipped plan that determines as much of the geometry as any circular test."""


@dataclass(frozen=True)
class NextStep:
    """One step: what to do, why, and a command where one does it."""

    sentence: str
    command: str = ""


def next_steps(
    samples: Samples, model: Model, comparison: Comparison, sufficiency: Sufficiency, rank: int | None
) -> tuple[NextStep, ...]:
    """Return the steps that these records and this model suggest, the first first; one at least."""
    found = [*_missing(comparison, sufficiency), *_coverage(samples), *_rank(model, rank)]
    if not found:
        found.append(_compensate(samples))
    return tuple(found)


def _missing(comparison: Comparison, sufficiency: Sufficiency) -> Iterator[NextStep]:
    if sufficiency.is_sufficient:
        return
    choices = () if comparison.cause is None else comparison.cause.choices
    yield NextStep(
        "Find what the model lacks before measuring more: it leaves more than noise, which makes every uncertainty here"
        " larger.",
        "hexdbb discover RECORD -m MODEL",
    )
    if choices:
        yield NextStep(
            "Add the likely cause, if discover confirms it, and look again.",
            f"hexdbb add {' '.join(choices)} -m MODEL RECORD",
        )


def _coverage(samples: Samples) -> Iterator[NextStep]:
    keys = np.column_stack([samples["record"], samples["circle"]])
    each = [keys[:, None, :] == one for one in np.unique(keys, axis=0)]
    rows = [mask.all(axis=2)[:, 0] for mask in each]
    if any(len(np.unique(samples["direction"][row])) < 2 for row in rows):
        yield NextStep("Drive every circle in both directions: play, friction and lag show in their difference only.")
    if any(len(np.unique(samples["feed_mm_s"][row])) < 2 for row in rows):
        yield NextStep("Drive two feeds at least, one slow and one fast: lag grows with speed, play does not.")
    if len(np.unique(samples["lap"])) < 2:
        yield NextStep("Drive two laps at least: their difference is the noise, and shows whether the machine repeats.")


def _rank(model: Model, rank: int | None) -> Iterator[NextStep]:
    if rank is None:
        return
    plan = load_plan(FULL_PLAN)
    possible = observability(plan_sensitivity(plan, model, model.machine.can_setup.cycle_rate_hz)).rank
    if possible > rank:
        yield NextStep(
            f"Drive the plan {FULL_PLAN}: seven circles with the platform tilted and turned determine {possible}"
            f" combinations of the machine's errors, these readings {rank}.",
            f"hexdbb-run --plan {FULL_PLAN} -o RECORD",
        )


def _compensate(samples: Samples) -> NextStep:
    if any("compensation" in record.metadata for record in samples.records):
        return NextStep(
            "Repeat the test when the machine has warmed up, been moved or been mended: the model explains it as it is"
            " now.",
            f"hexdbb-run --plan {FULL_PLAN} --compensation FILE -o RECORD",
        )
    return NextStep(
        "Compensate the machine and measure again: nothing that matters is missing, and no circular test determines"
        " more.",
        "hexdbb compensate MODEL -o FILE",
    )
