"""`hexdbb plan propose`: the circles that tell most."""

from __future__ import annotations

import os
from pathlib import Path

import click
from rich.console import Console

from hexdbb.cli.plan_judgement import Judgement, judge, noise_option, plan_noise_mm
from hexdbb.cli.plan_sheets import print_circles, print_comparison
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing, replacing
from hexdbb.files.validation import dump_toml, parse_toml
from hexdbb.machine import SHIPPED_MACHINE, load_machine
from hexdbb.model import new_model
from hexdbb.plan import Plan, load_plan
from hexdbb.planning import CRITERIA, GRIDS, Demands, Question, propose, unknowns_of


@click.command("propose", short_help="choose the circles that tell most")
@click.option("--circles", type=int, required=True, help="How many circles to choose.")
@click.option("--aim", metavar="EFFECT", help="Effect the plan is to tell best; default: all 33 errors of the thesis.")
@click.option(
    "--criterion",
    default="D",
    show_default=True,
    help=f"What makes a choice good: {' or '.join(CRITERIA)} (largest smallest singular value).",
)
@click.option("--mounts", type=int, default=1, show_default=True, help="Places of the tool cup, at most.")
@click.option("--off-nominal", is_flag=True, help="Let radii differ from the bar's length; --aim does so by itself.")
@click.option(
    "--bar-angle",
    "bar_angle_deg",
    type=click.FloatRange(0.0, 90.0),
    default=Demands.bar_angle_deg,
    show_default=True,
    help="Largest angle of the bar out of the plane of cup or platform, deg.",
)
@click.option("--grid", type=click.Choice(list(GRIDS)), default="fine", show_default=True, help="How much is tried.")
@click.option("--like", default="standard", show_default=True, help="Plan that lends gauge, ball, cup, feeds and laps.")
@click.option("--machine", "machine_path", type=click.Path(path_type=Path), help="Machine file in place of its own.")
@noise_option
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, help="Plan file to write.")
@click.option("--overwrite", is_flag=True, help="Replace the file where there is one.")
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
    """Choose circles that tell most of the machine and write them as a plan.

    Chosen among cup places, platform orientations, circle planes and radii that the machine reaches with clearance of
    slider travel, slider gaps, the bar's angle in its cups, and singular poses; by greedy exchange, then refined.

    \b
    Examples:
      hexdbb plan propose --circles 5 -o plan.toml
      hexdbb plan propose --circles 7 --criterion minmax --mounts 2 -o plan.toml
      hexdbb plan propose --circles 3 --aim leg_length -o legs.toml
    """
    refuse_existing(output, overwrite)
    lender = load_plan(like)
    machine = lender.machine_file() if machine_path is None else load_machine(machine_path)
    lender = lender.model_copy(update={"machine": _machine_name(lender, machine_path, output)})
    rate_hz = machine.can_setup.cycle_rate_hz
    model = new_model(machine)
    question = Question(
        like=lender,
        machine=machine,
        unknowns=unknowns_of(model, aim, plan_noise_mm(lender, noise_um), rate_hz),
        circles=circles,
        criterion=criterion,
        most_mounts=mounts,
        off_nominal=off_nominal or aim is not None,
        demands=Demands(bar_angle_deg=bar_angle_deg),
        grid=GRIDS[grid],
    )
    with Console(stderr=True).status("planning") as status:
        plan = propose(question, status.update)
    _write(plan, f"{circles} circles that tell most of {aim or 'all errors of the machine'}, by {criterion}", output)
    print_circles(plan)
    found = {str(output): (plan, judge(plan, model, rate_hz, noise_um, str(output)))}
    try:
        found = {like: (lender, judge(lender, model, rate_hz, noise_um, like)), **found}
    except InputError as error:
        click.echo(f"not held beside {like}, which this machine cannot follow: {error}", err=True)
    print_comparison(found)
    if aim is not None:
        _print_aim(aim, {name: each for name, (_, each) in found.items()})
    click.echo(f"{output}: plan written", err=True)


def _write(plan: Plan, what: str, output: Path) -> None:
    text = f"# {what}; chosen by hexdbb plan propose.\n{dump_toml(plan)}"
    parse_toml(text, Plan, str(output))
    with replacing(output) as temporary:
        temporary.write_text(text, encoding="utf-8")


def _print_aim(aim: str, found: dict[str, Judgement]) -> None:
    for name, each in found.items():
        size = each.detectable[aim]
        shown = "never shows alone" if size.size is None else f"shows from {size.size:.3g} {size.unit}"
        click.echo(f"{aim} {shown} with {name}")


def _machine_name(lender: Plan, machine_path: Path | None, output: Path) -> str:
    """Name the machine as the new file will find it: the shipped one by name, others relative to it."""
    if machine_path is None and lender.machine == SHIPPED_MACHINE:
        return SHIPPED_MACHINE
    beside = lender.path.parent if lender.path is not None else Path()
    path = machine_path if machine_path is not None else beside / lender.machine
    return Path(os.path.relpath(path, output.parent)).as_posix()
