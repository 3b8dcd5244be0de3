"""Which circles determine most: many searches from grids of candidates drawn at random, their plans compared.

A search is that of `hexdbb plan propose`: greedy exchange among the circles of a grid, refined off it. It is
deterministic, but what it finds depends on the grid; here every case draws a grid of its own (heights and places of the
cup, tilts and their azimuths), so that all together try thousands of circles that no one grid has. Plans of equally
many circles compare by the uncertainty of the ball's position that a diagnosis of them would state, over the workspace.
Bounds: how likely one more search would find a better plan, from how many came near the best.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pyarrow as pa

from hexdbb.diagnosis.place_uncertainty import place_uncertainty
from hexdbb.errors import InputError, RunError
from hexdbb.files.validation import dump_toml, parse_toml
from hexdbb.identifiability import expected_covariance, observability, plan_sensitivity
from hexdbb.model import new_model
from hexdbb.plan import Plan
from hexdbb.planning import Grid, PlanRequest, RequiredClearances, planned_unknowns, propose
from hexdbb.studies.rates import quantile, share
from hexdbb.studies.setting import Setting
from hexdbb.studies.study import Case, Result, Row, Sheet, Study, number, percent

SIXTH_DEG, THIRD_DEG = 60.0, 120.0
"""Azimuths of tilts lie a sixth of a turn apart, those of cup places a third: the machine's symmetry."""
LOWEST, HIGHEST, WIDEST = -0.6, 0.2, 0.4
"""Cup positions from the plan's first, in bar lengths, as in the grid of `hexdbb plan propose`."""
COLUMNS = pa.schema(
    [
        ("case", pa.int64()),
        ("search", pa.int64()),
        ("circles", pa.int64()),
        ("cups", pa.int64()),
        ("rank", pa.int64()),
        ("condition", pa.float64()),
        ("place_um", pa.float64()),
        ("place_worst_um", pa.float64()),
        ("plan", pa.string()),
        ("refused", pa.string()),
    ]
)


@dataclass(frozen=True)
class Assessed:
    """What a plan would determine: rank, condition, and the stated uncertainty of the ball's position, µm."""

    rank: int
    condition: float
    place_um: float
    place_worst_um: float


def cases(setting: Setting) -> list[Case]:
    """Return the numbers of circles in turn, search after search."""
    counts = setting.file.plan_search.circles
    return [
        {"case": case, "search": setting.number(case // len(counts)), "circles": counts[case % len(counts)]}
        for case in range(setting.file.cases)
    ]


def row(setting: Setting, case: Case) -> Row:
    """Return the plan that one search found, and what it would determine."""
    asked, machine = setting.file.plan_search, setting.machine
    model, rate_hz = new_model(machine), machine.can_setup.cycle_rate_hz
    request = PlanRequest(
        template=setting.plan,
        machine=machine,
        unknowns=planned_unknowns(model, None, setting.noise_mm, rate_hz),
        circles=case["circles"],
        criterion=asked.criterion,
        most_mounts=asked.mounts,
        required=RequiredClearances(bar_angle_deg=asked.bar_angle_deg),
        grid=drawn_grid(setting, np.random.default_rng([case["search"], case["circles"]])),
    )
    try:
        plan = propose(request)
    except (InputError, RunError) as error:
        nothing = dict.fromkeys(("cups", "rank", "condition", "place_um", "place_worst_um", "plan"))
        return {**case, **nothing, "refused": str(error)}
    cups = len({each.mount for each in plan.circles})
    return {**case, "cups": cups, **vars(assessed(plan, setting)), "plan": dump_toml(plan), "refused": None}


def drawn_grid(setting: Setting, draw: np.random.Generator) -> Grid:
    """Return a grid of a few hundred circles within the study's limits, drawn at random."""
    asked = setting.file.plan_search

    def azimuths(step_deg: float) -> tuple[float, ...]:
        first = float(draw.uniform(0.0, step_deg))
        return tuple(first + step_deg * each for each in range(round(360.0 / step_deg)))

    def up_to(limit: float) -> float:
        # The larger half: small tilts are what refinement reaches from level.
        return float(draw.uniform(0.5 * limit, limit))

    return Grid(
        heights=(0.0, float(draw.uniform(LOWEST, HIGHEST))),
        places=(0.0,) if draw.random() < 0.5 else (float(draw.uniform(0.0, WIDEST)),),
        place_azimuths=azimuths(THIRD_DEG)[:1],
        tilts=(0.0, up_to(asked.tilt_deg)),
        tilt_azimuths=azimuths(SIXTH_DEG),
        yaws=(-up_to(asked.yaw_deg), 0.0, up_to(asked.yaw_deg)),
        plane_tilts=(0.0, up_to(asked.plane_deg)),
        plane_azimuths=azimuths(SIXTH_DEG),
    )


def assessed(plan: Plan, setting: Setting) -> Assessed:
    """Return what a plan would determine of the machine, at the controller's rate of readings."""
    model = new_model(setting.machine)
    sensitivity = plan_sensitivity(plan, model, setting.machine.can_setup.cycle_rate_hz)
    found, covariance = observability(sensitivity), expected_covariance(sensitivity, setting.noise_mm)
    # The pose grid of the study's own plan, so that all plans are judged by the same poses.
    circle = setting.plan.circles[0]
    place = place_uncertainty(sensitivity.model, covariance, circle, setting.plan.mount_of(circle).cup_mm)
    place_um = 1e3 * float(np.sqrt(np.mean(place.sigma_mm**2)))
    return Assessed(found.rank, found.condition, place_um, place.worst_um)


def result(setting: Setting, rows: Sequence[Row]) -> Result:
    """Return the best plan of each number of circles, and how sure it is that no search finds a better one."""
    from hexdbb.studies.plan_picture import plan_figure

    near, searched = setting.file.plan_search.near, [each for each in rows if each["refused"] is None]
    groups = {
        count: [each for each in searched if each["circles"] == count] for count in setting.file.plan_search.circles
    }
    groups = {count: own for count, own in groups.items() if own}
    if not groups:
        raise RunError(f"no search found a plan: {rows[0]['refused']}")
    own_plan = assessed(setting.plan, setting)
    best = {count: min(own, key=lambda each: float(each["place_um"])) for count, own in groups.items()}
    lines = []
    for count, own in groups.items():
        values = [float(each["place_um"]) for each in own]
        close = share(sum(value <= (1.0 + near) * min(values) for value in values), len(values))
        chosen = best[count]
        lines.append(
            (
                str(count),
                str(len(own)),
                f"{chosen['place_um']:.3g}",
                f"{chosen['place_worst_um']:.3g}",
                f"{chosen['rank']}",
                f"{chosen['condition']:.0f}",
                *number(quantile(values, 0.5)),
                *percent(close, 0),
            )
        )
    circles = len(setting.plan.circles)
    lines.append(
        (
            f"{circles}, the study's plan",
            "-",
            f"{own_plan.place_um:.3g}",
            f"{own_plan.place_worst_um:.3g}",
            f"{own_plan.rank}",
            f"{own_plan.condition:.0f}",
            "-",
            "-",
            "-",
            "-",
        )
    )
    head = (
        "circles",
        "searches",
        "best µm",
        "its worst µm",
        "rank",
        "condition",
        "median µm",
        "95 % bounds",
        f"within {100 * near:g} %",
        "95 % bounds",
    )
    answer = tuple(_sentence(count, groups[count], best[count], own_plan) for count in groups)
    sheet = Sheet("stated uncertainty of the ball's position, RMS over the workspace", head, tuple(lines))
    plans = {f"{count}-circles": parse_toml(str(each["plan"]), Plan, "a search") for count, each in best.items()}
    return Result(answer, (sheet,), lambda: plan_figure(groups, own_plan.place_um, circles), plans=plans)


def _sentence(count: int, own: Sequence[Row], best: Row, own_plan: Assessed) -> str:
    # None of n searches was better than the best of them: the rule of three, as an exact bound.
    better = share(0, len(own)).high
    compared = float(best["place_um"]) / own_plan.place_um
    return (
        f"{count} circles: uncertainty of the ball's position {best['place_um']:.3g} µm RMS, {compared:.2g} of that of"
        f" the study's plan; another search finds a better plan with a probability of at most {100.0 * better:.0f} %"
        f" (95 % bound of {len(own)} searches)"
    )


STUDY = Study("plan", "Which circles determine most?", COLUMNS, cases, row, result)
