"""`hexdbb plan propose`: choose the circles that determine most."""

from __future__ import annotations

import os
from pathlib import Path

import click

from hexdbb.cli.consoles import message_console, say
from hexdbb.cli.plan_assessment import PlanAssessment, assess_plan, noise_option, plan_noise_mm
from hexdbb.cli.plan_tables import print_circles, print_comparison, warn_of_condition
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing
from hexdbb.machine import SHIPPED_MACHINE, load_machine
from hexdbb.model import new_model
from hexdbb.plan import Plan, load_plan, save_plan
from hexdbb.planning import CRITERIA, GRIDS, PlanRequest, RequiredClearances, planned_unknowns, propose
from hexdbb.units import readable_unit


@click.command("propose", short_help="choose the circles that determine most")
@click.option("--circles", type=int, required=True, help="How many circles to choose.")
@click.option("--aim", metavar="EFFECT", help="Effect to determine best; default: all 33 errors of the thesis.")
@click.option(
    "--criterion",
    default="D",
    show_default=True,
    help=f"Quantity to maximise: {' or '.join(CRITERIA)} (the smallest singular value).",
)
@click.option("--mounts", type=int, default=1, show_default=True, help="Largest number of cup positions.")
@click.option("--off-nominal", is_flag=True, help="Allow radii that differ from the bar's length; implied by --aim.")
@click.option(
    "--bar-angle",
    "bar_angle_deg",
    type=click.FloatRange(0.0, 90.0),
    default=RequiredClearances.bar_angle_deg,
    show_default=True,
    help="Largest angle of the bar out of the plane of cup or platform, deg.",
)
@click.option(
    "--grid", type=click.Choice(list(GRIDS)), default="fine", show_default=True, help="Size of the grid of candidates."
)
@click.option(
    "--like", default="standard", show_default=True, help="Plan whose gauge, ball, cup, feeds and laps are used."
)
@click.option(
    "--machine", "machine_path", type=click.Path(path_type=Path), help="Machine file to use instead of that plan's."
)
@noise_option
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, help="Plan file to write.")
@click.option("--overwrite", is_flag=True, help="Replace an existing file.")
def propose_command(
    circles: int,
    aim: str | None,
    criterion: str,
    mounts: int,
    off_nominal: bool,
    bar_angle_deg: float,
    grid: str,
    like: str,
    machine_path: Path | None,
    noise_um: float | None,
    output: Path,
    overwrite: bool,
) -> None:
    """Choose the circles that determine most of the machine and write them as a plan.

    Candidates are cup positions, platform orientations, circle planes and radii that keep clearances to the ends of
    slider travel, between sliders, of the bar's angle in its cups and to singular poses. The choice is made by greedy
    exchange on a grid and refined off it.

    \b
    Examples:
      hexdbb plan propose --circles 5 -o plan.toml
      hexdbb plan propose --circles 7 --criterion minmax --mounts 2 -o plan.toml
      hexdbb plan propose --circles 3 --aim leg_length -o legs.toml
    """
    refuse_existing(output, overwrite)
    template = load_plan(like)
    machine = template.machine_file() if machine_path is None else load_machine(machine_path)
    template = template.model_copy(update={"machine": _machine_name(template, machine_path, output)})
    rate_hz = machine.can_setup.cycle_rate_hz
    model = new_model(machine)
    request = PlanRequest(
        template=template,
        machine=machine,
        unknowns=planned_unknowns(model, aim, plan_noise_mm(template, noise_um), rate_hz),
        circles=circles,
        criterion=criterion,
        most_mounts=mounts,
        off_nominal=off_nominal or aim is not None,
        required=RequiredClearances(bar_angle_deg=bar_angle_deg),
        grid=GRIDS[grid],
    )
    with message_console().status("planning") as status:
        plan = propose(request, status.update)
    what = f"{circles} circles that determine most of {aim or 'all errors of the machine'}, by {criterion}"
    save_plan(plan, output, f"{what}; chosen by hexdbb plan propose.")
    print_circles(plan)
    found = {str(output): (plan, assess_plan(plan, model, rate_hz, noise_um, str(output)))}
    try:
        found = {like: (template, assess_plan(template, model, rate_hz, noise_um, like)), **found}
    except InputError as error:
        say(f"not compared with {like}, which this machine cannot follow: {error}", err=True)
    print_comparison(found)
    warn_of_condition(str(output), found[str(output)][1])
    if aim is not None:
        _print_aim(aim, {name: each for name, (_, each) in found.items()})
    say(f"{output}: plan written", err=True)


def _print_aim(aim: str, found: dict[str, PlanAssessment]) -> None:
    for name, each in found.items():
        size = each.detectable[aim]
        shown = "not detectable with this plan"
        if size.size is not None:
            shown = f"detectable from {size.size:.3g} {readable_unit(size.unit)}"
        say(f"{name}: {aim} {shown}")


def _machine_name(template: Plan, machine_path: Path | None, output: Path) -> str:
    """Return the machine as the new file refers to it: the shipped one by name, others relative to the file."""
    if machine_path is None and template.machine == SHIPPED_MACHINE:
        return SHIPPED_MACHINE
    beside = template.path.parent if template.path is not None else Path()
    path = machine_path if machine_path is not None else beside / template.machine
    return Path(os.path.relpath(path, output.parent)).as_posix()
