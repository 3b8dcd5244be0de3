"""Printed tables of the plan commands."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from rich.box import SIMPLE_HEAD
from rich.table import Table

from hexdbb.cli.consoles import output_console, say
from hexdbb.cli.plan_assessment import PlanAssessment
from hexdbb.identifiability import TRUSTED_CONDITION, Expectation
from hexdbb.machine import Limits
from hexdbb.plan import Plan
from hexdbb.planning import Clearances, angle_of_row
from hexdbb.units import readable_unit, shown_factor

NOT_DETECTABLE = "not"
"""Shown where no size of an effect that a machine can have is detectable with a plan."""
LIMITED = (("velocity", "mm_s"), ("acceleration", "mm_s2"), ("jerk", "mm_s3"))
"""Rates of the sliders that have a limit, in order of differentiation, with the unit of their keys."""


def print_motion(title: str, runs: Iterable[Mapping[str, float]], limits: Limits) -> None:
    """Print the margins of each run and its share of the sliders' limits."""
    headings = ("circle", "mm/min", "sense", "samples", "travel", "gap", "speed%", "accel.%", "jerk%")
    rows = []
    for run in runs:
        shares = [100.0 * run[f"{name}_{unit}"] / getattr(limits, f"{name}_{unit}") for name, unit in LIMITED]
        named = (f"{run['circle']:g}", f"{run['feed_mm_min']:g}", f"{run['direction']:+g}", f"{run['samples']:g}")
        left = (f"{run['to_end_of_travel_mm']:.1f}", f"{run['to_min_gap_mm']:.1f}")
        rows.append((*named, *left, *(f"{share:.1f}" for share in shares)))
    print_table(headings, rows, title=title)
    of = ", ".join(f"{getattr(limits, f'{name}_{unit}'):g} {unit.replace('_', '/')}" for name, unit in LIMITED)
    say(f"travel: mm to its ends; gap: mm between two sliders above the smallest gap; % of the sliders' limits, {of}")


def print_nearest(nearest: Mapping[str, Mapping[str, Any]]) -> None:
    """Print which sliders come nearest to each other and to an end of travel in the whole motion, and where."""
    pair, end = nearest["sliders"], nearest["end_of_travel"]
    one, other = pair["sliders"]
    say(
        f"nearest: sliders {one} and {other} come within {pair['distance_mm']:.1f} mm of each other (smallest gap"
        f" {pair['min_gap_mm']:g} mm), {_place(pair)}"
    )
    say(
        f"nearest: slider {end['slider']} comes within {end['left_mm']:.1f} mm of its end of travel at"
        f" {end['end_mm']:g} mm, {_place(end)}\n"
    )


def _place(at: Mapping[str, Any]) -> str:
    if at["circle"] is None:
        return "between circles"
    if at["angle_deg"] is None:
        return f"on the way to or from circle {at['circle']}"
    return f"on circle {at['circle']} at {at['angle_deg']:.0f} deg, direction {at['direction']:+d}"


def print_clearances(clearances: Mapping[int, Clearances]) -> None:
    """Print the clearances of each circle, which are common to its runs."""
    headings = ("circle", "travel", "of slider", "gap", "between", "at deg", "bar deg", "pose condition")
    rows = []
    for identity, each in clearances.items():
        assert each.nearest is not None and each.nearest_end is not None  # of every circle within reach
        rows.append(
            (
                str(identity),
                f"{each.to_end_of_travel_mm:.1f}",
                str(each.nearest_end.slider),
                f"{each.to_min_gap_mm:.1f}",
                f"{each.nearest.first} and {each.nearest.second}",
                f"{angle_of_row(each.nearest.row):.0f}",
                f"{each.bar_angle_deg:.1f}",
                f"{each.condition:.1f}",
            )
        )
    print_table(headings, rows, title="clearances, feed-in included")
    joints = [(each.to_joint_limit_deg, identity) for identity, each in clearances.items()]
    if joints and np.isfinite(min(joints)[0]):
        left, identity = min(joints)
        say(f"joints: at least {left:.1f} deg are left to the limits of [joints], least on circle {identity}")
    say(
        "gap: mm above the smallest gap, between which sliders and at which angle; bar: largest angle of the bar out of"
        " the plane of cup or platform; pose condition: largest condition of the"
        " machine's Jacobian, 1 is best\n"
    )


def print_assessment(assessment: PlanAssessment) -> None:
    """Print what a plan determines, how well, and which combinations it does not identify."""
    seen = assessment.observability
    say(
        f"rank {seen.rank} of {seen.values} errors of the machine (set-up unknowns eliminated), condition"
        f" {seen.condition:.0f}, O1 {seen.o1:.2e}, O3 {seen.o3:.2e}, O4 {seen.o4:.2e}"
    )
    expected: dict[str, list[Expectation]] = {}
    for each in assessment.expected:
        expected.setdefault(each.parameter.effect, []).append(each)
    rows = []
    for effect, size in assessment.detectable.items():
        shown = NOT_DETECTABLE if size.size is None else _digits(size.size, 3)
        known = _identifiable(expected.get(effect, []))
        rows.append((effect, *known, shown, readable_unit(size.unit), _digits(100.0 * size.kept, 2)))
    title = f"expected at {assessment.noise_um:.2f} µm of noise, {assessment.readings:,.0f} readings"
    print_table(("effect", "identified", "± 1 sigma", "detectable", "unit", "own %"), rows, title=title, names=1)
    say(
        "identified: values determined on their own; own %: part of an effect that no other value explains;\n"
        "detectable: smallest size at which that part has an RMS of three times the noise;\n"
        f"{NOT_DETECTABLE}: not detectable with this plan at any size that a machine can have"
    )
    if seen.unidentifiable:
        say("\nNot identifiable with this plan, to first order:")
        for sentence in seen.unidentifiable:
            say(f"  {sentence}")


def print_comparison(plans: Mapping[str, tuple[Plan, PlanAssessment]]) -> None:
    """Print several plans side by side."""
    headings = ("plan", "circles", "cups", "rank", "condition", "O1", "O3", "O4", "readings")
    rows = []
    for name, (plan, assessment) in plans.items():
        seen = assessment.observability
        indices = (f"{each:.2e}" for each in (seen.o1, seen.o3, seen.o4))
        counts = (str(len(plan.circles)), str(len({each.mount for each in plan.circles})), str(seen.rank))
        rows.append((name, *counts, f"{seen.condition:.0f}", *indices, f"{assessment.readings:,.0f}"))
    print_table(headings, rows, names=1)
    say("condition: smaller is better; O1, O3, O4 (per reading, mm per prior standard deviation): larger is better")


def warn_of_condition(name: str, assessment: PlanAssessment) -> None:
    """Warn, on stderr, of a condition above which an identification is not trusted."""
    condition = assessment.observability.condition
    if condition <= TRUSTED_CONDITION:
        return
    say(
        f"{name}: condition {condition:.0f} (expected at most {TRUSTED_CONDITION:.0f} for an identification to be"
        " trusted): the least determined combination of errors takes in what temperature and set-up do; hexdbb plan"
        " propose with more --circles, --criterion minmax or a larger --bar-angle may lower it",
        err=True,
    )


def print_circles(plan: Plan) -> None:
    """Print the circles of a plan."""
    rows = [
        (
            str(each.id),
            *(_triple(values) for values in (plan.mount_of(each).cup_mm, each.platform_rpy_deg, each.plane_rpy_deg)),
            f"{each.radius_mm:g}",
        )
        for each in plan.circles
    ]
    print_table(("circle", "cup mm", "platform rpy deg", "plane rpy deg", "radius mm"), rows)


def print_table(
    headings: Sequence[str], rows: Iterable[Sequence[str]], *, title: str | None = None, names: int = 0
) -> None:
    """Print a table; the first `names` columns are text, the others numbers."""
    table = Table(title=title, title_justify="left", box=SIMPLE_HEAD, pad_edge=False)
    for index, heading in enumerate(headings):
        table.add_column(heading, justify="left" if index < names else "right", no_wrap=True)
    for row in rows:
        table.add_row(*row)
    output_console().print(table)


def _identifiable(expected: Sequence[Expectation]) -> tuple[str, str]:
    """Return how many values of an effect are identifiable, and the range of their uncertainties."""
    if not expected:
        return "-", "-"
    sigmas = [each.sigma * shown_factor(each.parameter.unit) for each in expected if each.identifiable]
    count = f"{len(sigmas)} of {len(expected)}"
    if not sigmas:
        return count, "~"
    least, most = _digits(min(sigmas), 3), _digits(max(sigmas), 3)
    return count, least if least == most else f"{least} .. {most}"


def _triple(values: Sequence[float]) -> str:
    return ", ".join(f"{value:g}" for value in values)


def _digits(value: float, digits: int) -> str:
    """Return a number rounded to some significant digits, without an exponent below a million."""
    return f"{float(f'{value:.{digits}g}'):g}"
