"""`hexdbb machine new`: a machine file, a picture of the machine and a plan of circles, from questions or options."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hexdbb.cli.consoles import message_console, say
from hexdbb.cli.machine_check import assessed, check_picture, draw
from hexdbb.cli.machine_questions import QUESTIONS, ask
from hexdbb.cli.machine_tables import print_assessment
from hexdbb.cli.prompts import prompted
from hexdbb.cli.workspace_option import FORM, workspace_of, workspace_text
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing, write_text
from hexdbb.files.validation import dump_toml, parse_toml
from hexdbb.machine import MachineFile, Workspace

if TYPE_CHECKING:
    from hexdbb.plan import Plan

CIRCLES = 7
"""Circles proposed where no number is given: as many as the plan `standard` has."""
BARS_MM = (300.0, 150.0, 100.0, 50.0)
"""Lengths of common ball bars."""


def _asks(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add an option for each question."""
    for question in reversed(QUESTIONS):
        command = click.option(f"--{question.option}", metavar="TEXT", help=f"{question.text}.")(command)
    return command


@click.command("new", short_help="a machine file, its picture and a plan, from questions or options")
@click.option("-o", "--output", required=True, type=click.Path(path_type=Path), help="Machine file to write.")
@click.option("--defaults", is_flag=True, help="Ask nothing: what is not given by options has its default.")
@_asks
@click.option(
    "--workspace",
    type=workspace_of,
    metavar=FORM,
    help="Where the platform is wanted: X,Y,Z,RADIUS[,HEIGHT[,TILT]], mm and deg; default: one that is reached.",
)
@click.option(
    "--bar", "bar_mm", type=float, help="Length of the ball bar, mm; default: the longest common one that fits."
)
@click.option("--circles", type=click.IntRange(min=0), help=f"Circles to propose; 0: no plan; default: {CIRCLES}.")
@click.option(
    "--grid",
    type=click.Choice(["fine", "coarse"]),
    default="fine",
    show_default=True,
    help="Size of the grid of candidate circles.",
)
@click.option(
    "--plan", "plan_path", type=click.Path(path_type=Path), help="Plan file; default: NAME-plan.toml beside it."
)
@click.option("--plot", type=click.Path(path_type=Path), help="Picture (.png or .svg); default: NAME.png beside it.")
@click.option("--overwrite", is_flag=True, help="Replace existing files.")
def new(
    output: Path,
    defaults: bool,
    workspace: Workspace | None,
    bar_mm: float | None,
    circles: int | None,
    grid: str,
    plan_path: Path | None,
    plot: Path | None,
    overwrite: bool,
    **given: str | None,
) -> None:
    """Describe a machine: write its machine file, a picture of it to scale, and a plan of circles it can follow.

    Asks for what no option gives, with a default in brackets; with --defaults nothing is asked. The machine is checked
    over its workspace: reach, ends of travel, gaps of sliders, singular poses.

    \b
    Examples:
      hexdbb machine new -o machine.toml
      hexdbb machine new -o big.toml --defaults --inradius 400 --leg-length 650
      hexdbb machine new -o mine.toml --defaults --guideway-angles 0,100,230 --leg-length 398,403,407,391,400,412
    """
    from hexdbb.workspace import plan_template

    plan_path = plan_path or output.with_name(f"{output.stem}-plan.toml")
    plot = plot or output.with_suffix(".png")
    for path in (output, plan_path, plot):
        refuse_existing(path, overwrite)
    check_picture(plot)
    interactive = not defaults
    machine = ask({key.replace("_", "-"): text for key, text in given.items()}, str(output), interactive)
    machine, assessment = _with_workspace(machine, workspace, str(output), interactive)
    space = machine.workspace
    assert space is not None  # set above
    bar_mm = bar_mm or next((each for each in BARS_MM if each <= space.radius_mm), BARS_MM[-1])
    if interactive and circles is None:
        circles = prompted("circles", "Circles to propose, 0 for no plan", default=CIRCLES, type=click.IntRange(min=0))
    circles = CIRCLES if circles is None else circles
    template = None if circles == 0 else plan_template(machine, space, bar_mm)
    _save(machine, output)
    print_assessment(machine, assessment, is_wanted=True)
    draw(machine, space, plot)
    if template is not None:
        template = template.model_copy(
            update={"machine": os.path.relpath(output, plan_path.parent).replace(os.sep, "/")}
        )
        _propose(machine, template, circles, grid, plan_path, assessment.condition)


def _with_workspace(
    machine: MachineFile, workspace: Workspace | None, origin: str, interactive: bool
) -> tuple[MachineFile, Any]:
    """Return the machine with its workspace and the assessment of it; a workspace out of reach is asked for again."""
    from hexdbb.workspace import suggested_workspace

    asked = workspace is None and interactive
    if workspace is None:
        workspace = suggested_workspace(machine)
    while True:
        if asked:
            text = "Where the platform is wanted: x,y,z of its centre, radius, height, tilt; mm and deg"
            workspace = prompted("workspace", text, default=workspace_text(workspace), value_proc=workspace_of)
        assert workspace is not None  # given, suggested or asked for
        try:
            _, assessment = assessed(machine, workspace, origin)
            return machine.model_copy(update={"workspace": workspace}), assessment
        except InputError as error:
            if not asked:
                raise
            say(f"  {error}", err=True)


def _save(machine: MachineFile, path: Path) -> None:
    text = "# Written by hexdbb machine new; keys: docs/machine-file.md.\n" + dump_toml(machine)
    parse_toml(text, MachineFile, str(path))
    write_text(path, text)
    say(f"{path}: machine file written", err=True)


def _propose(machine: MachineFile, template: Plan, circles: int, grid: str, path: Path, condition: float) -> None:
    """Choose circles that go no nearer to singular poses than the workspace does, and write them as a plan."""
    from hexdbb.cli.plan_assessment import assess_plan, plan_noise_mm
    from hexdbb.cli.plan_tables import print_circles, print_comparison, warn_of_condition
    from hexdbb.model import new_model
    from hexdbb.plan import save_plan
    from hexdbb.planning import GRIDS, PlanRequest, RequiredClearances, planned_unknowns, propose

    model, rate_hz = new_model(machine), machine.can_setup.cycle_rate_hz
    usual = RequiredClearances()
    request = PlanRequest(
        template=template,
        machine=machine,
        unknowns=planned_unknowns(model, None, plan_noise_mm(template, None), rate_hz),
        circles=circles,
        criterion="minmax",
        required=RequiredClearances(condition=max(usual.condition, condition)),
        grid=GRIDS[grid],
    )
    with message_console().status("planning") as status:
        plan = propose(request, status.update)
    save_plan(plan, path, f"{circles} circles that determine most of {machine.name}; chosen by hexdbb machine new.")
    print_circles(plan)
    assessment = assess_plan(plan, model, rate_hz, None, str(path))
    print_comparison({str(path): (plan, assessment)})
    warn_of_condition(str(path), assessment)
    say(f"{path}: plan written; look at it with: hexdbb plan check {path}", err=True)
