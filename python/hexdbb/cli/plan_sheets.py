"""Tables of the plan commands, for people."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import click
from rich.box import SIMPLE_HEAD
from rich.table import Table

from hexdbb.cli.consoles import output_console
from hexdbb.cli.plan_judgement import Judgement
from hexdbb.identifiability import Expectation
from hexdbb.machine import Limits
from hexdbb.plan import Plan
from hexdbb.planning import Clearances
from hexdbb.units import shown_factor

LIMITED = (("velocity", "mm_s"), ("acceleration", "mm_s2"), ("jerk", "mm_s3"))
"""Rates of the sliders that have a limit, in order of differentiation, with the unit of their keys."""


def print_motion(title: str, runs: Iterable[Mapping[str, float]], limits: Limits) -> None:
    """Print how much of the sliders' limits each run uses."""
    headings = ("circle", "mm/min", "sense", "samples", "travel", "gap", "speed%", "accel.%", "jerk%")
    rows = []
    for run in runs:
        shares = [100.0 * run[f"{name}_{unit}"] / getattr(limits, f"{name}_{unit}") for name, unit in LIMITED]
        named = (f"{run['circle']:g}", f"{run['feed_mm_min']:g}", f"{run['direction']:+g}", f"{run['samples']:g}")
        left = (f"{run['to_end_of_travel_mm']:.1f}", f"{run['to_min_gap_mm']:.1f}")
        rows.append((*named, *left, *(f"{share:.1f}" for share in shares)))
    print_sheet(headings, rows, title=title)
    of = ", ".join(f"{getattr(limits, f'{name}_{unit}'):g} {unit.replace('_', '/')}" for name, unit in LIMITED)
    click.echo(f"travel: mm left to its ends; gap: mm left between two sliders; % of the sliders' limits, {of}")


def print_clearances(clearances: Mapping[int, Clearances]) -> None:
    """Print the clearances of each circle that no single run owns."""
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
    print_sheet(headings, rows, title="clearances, the way in included")
    click.echo(
        "bar: its largest angle out of the plane of cup or platform; pose condition: how unequally sliders move the"
        " platform, 1 is best\n"
    )


def print_knowledge(found: Judgement) -> None:
    """Print what a plan can tell, how well, and what it cannot."""
    seen = found.observability
    click.echo(
        f"rank {seen.rank} of {seen.values} errors of the machine (set-up unknowns taken out), condition"
        f" {seen.condition:.0f}, O1 {seen.o1:.2e}, O3 {seen.o3:.2e}, O4 {seen.o4:.2e}"
    )
    expected: dict[str, list[Expectation]] = {}
    for each in found.expected:
        expected.setdefault(each.parameter.effect, []).append(each)
    rows = []
    for effect, size in found.detectable.items():
        shown = "never" if size.size is None else f"{size.size:.3g}"
        rows.append((effect, *_known(expected.get(effect, [])), shown, size.unit, f"{100.0 * size.kept:.2g}"))
    title = f"expected at {found.noise_um:.2f} um of noise, {found.readings:,.0f} readings"
    print_sheet(("effect", "known alone", "± 1 sigma", "detectable", "unit", "left %"), rows, title=title, names=1)
    click.echo(
        "known alone: values told without the help of others; detectable: smallest size whose part that nothing else\n"
        "explains (left %) has an RMS of three times the noise; never: absorbed by other errors"
    )
    if seen.unidentifiable:
        click.echo("\nWhat this plan cannot tell, to first order:")
        for sentence in seen.unidentifiable:
            click.echo(f"  {sentence}")


def print_comparison(plans: Mapping[str, tuple[Plan, Judgement]]) -> None:
    """Print several plans side by side."""
    headings = ("plan", "circles", "cups", "rank", "condition", "O1", "O3", "O4", "readings")
    rows = []
    for name, (plan, found) in plans.items():
        seen = found.observability
        indices = (f"{each:.2e}" for each in (seen.o1, seen.o3, seen.o4))
        counts = (str(len(plan.circles)), str(len({each.mount for each in plan.circles})), str(seen.rank))
        rows.append((name, *counts, f"{seen.condition:.0f}", *indices, f"{found.readings:,.0f}"))
    print_sheet(headings, rows, names=1)
    click.echo("condition: the smaller the better; O1, O3, O4 (of one reading, mm per expected size): the larger")


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
    print_sheet(("circle", "cup mm", "platform rpy deg", "plane rpy deg", "radius mm"), rows)


def print_sheet(
    headings: Sequence[str], rows: Iterable[Sequence[str]], *, title: str | None = None, names: int = 0
) -> None:
    """Print a table; the first `names` columns are words, the others numbers."""
    sheet = Table(title=title, title_justify="left", box=SIMPLE_HEAD, pad_edge=False)
    for index, heading in enumerate(headings):
        sheet.add_column(heading, justify="left" if index < names else "right", no_wrap=True)
    for row in rows:
        sheet.add_row(*row)
    output_console().print(sheet)


def _known(expected: Sequence[Expectation]) -> tuple[str, str]:
    """Give how many values of an effect are known alone, and how well."""
    if not expected:
        return "-", "-"
    sigmas = [each.sigma * shown_factor(each.parameter.unit) for each in expected if each.identifiable]
    count = f"{len(sigmas)} of {len(expected)}"
    if not sigmas:
        return count, "~"
    least, most = f"{min(sigmas):.3g}", f"{max(sigmas):.3g}"
    return count, least if least == most else f"{least} .. {most}"


def _triple(values: Sequence[float]) -> str:
    return ", ".join(f"{value:g}" for value in values)
