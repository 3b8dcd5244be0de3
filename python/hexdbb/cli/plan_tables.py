"""Printed tables of the plan commands."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from rich.box import SIMPLE_HEAD
from rich.table import Table

from hexdbb.cli.consoles import output_console, say
from hexdbb.cli.plan_assessment import PlanAssessment
from hexdbb.identifiability import Expectation
from hexdbb.machine import Limits
from hexdbb.plan import Plan
from hexdbb.planning import Clearances
from hexdbb.units import readable_unit, shown_factor

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


def print_clearances(clearances: Mapping[int, Clearances]) -> None:
    """Print the clearances of each circle, which are common to its runs."""
    headings = ("circle", "travel", "gap", "bar deg", "pose condition")
    rows = [
        (
            str(identity),
            f"{each.to_end_of_travel_mm:.1f}",
            f"{each.to_min_gap_mm:.1f}",
            f"{each.bar_angle_deg:.1f}",
            f"{each.condition:.1f}",
        )
        for identity, each in clearances.items()
    ]
    print_table(headings, rows, title="clearances, feed-in included")
    say(
        "bar: largest angle of the bar out of the plane of cup or platform; pose condition: largest condition of the"
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
        shown = "never" if size.size is None else _digits(size.size, 3)
        known = _identifiable(expected.get(effect, []))
        rows.append((effect, *known, shown, readable_unit(size.unit), _digits(100.0 * size.kept, 2)))
    title = f"expected at {assessment.noise_um:.2f} µm of noise, {assessment.readings:,.0f} readings"
    print_table(("effect", "identified", "± 1 sigma", "detectable", "unit", "own %"), rows, title=title, names=1)
    say(
        "identified: values determined on their own; own %: part of an effect that no other value explains;\n"
        "detectable: smallest size at which that part has an RMS of three times the noise; never: it has no such part"
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
