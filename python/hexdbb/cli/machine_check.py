"""`hexdbb machine check`: reach, limits and singular poses of a machine over its workspace."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hexdbb.cli.consoles import message_console, say
from hexdbb.cli.machine_tables import print_assessment
from hexdbb.cli.workspace_option import FORM, workspace_of
from hexdbb.errors import InputError, RunError
from hexdbb.files.atomic_file import refuse_existing
from hexdbb.machine import SHIPPED_MACHINE, MachineFile, Workspace, load_machine, shipped_machine

if TYPE_CHECKING:
    from hexdbb.workspace import Assessment


@click.command("check", short_help="reach, limits and singular poses over the workspace")
@click.argument("machine_path", metavar="MACHINE", type=click.Path(path_type=Path))
@click.option(
    "--workspace",
    type=workspace_of,
    metavar=FORM,
    help="Workspace to look at instead of the file's: X,Y,Z,RADIUS[,HEIGHT[,TILT]], mm and deg.",
)
@click.option("--plot", type=click.Path(path_type=Path), help="Picture to write (.png or .svg); replaces one there.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def check(machine_path: Path, workspace: Workspace | None, plot: Path | None, as_json: bool) -> None:
    """Check what a machine reaches, and how near it comes to its limits and to singular poses.

    MACHINE is a machine file, or sp120 for the shipped one. Looked at is the file's [workspace]; where it has none, a
    disc that a common ball bar's circle fills. Exit status 0: nothing is wrong; 1: something is, which is stated;
    2: the file is wrong, or the workspace is out of reach.

    \b
    Examples:
      hexdbb machine check machine.toml --plot machine.png
      hexdbb machine check sp120 --workspace 0,0,265,100,0,10
    """
    machine = shipped_machine() if str(machine_path) == SHIPPED_MACHINE else load_machine(machine_path)
    if plot is not None:
        check_picture(plot)
    looked_at, assessment = assessed(machine, workspace, str(machine_path))
    if as_json:
        say(json.dumps(_json(machine, assessment), indent=2))
    else:
        print_assessment(machine, assessment, is_wanted=workspace is not None or machine.workspace is not None)
    if plot is not None:
        draw(machine, looked_at, plot)
    if assessment.findings:
        raise RunError(f"{machine_path}: {assessment.findings[0]}")


def assessed(machine: MachineFile, wanted: Workspace | None, origin: str) -> tuple[Workspace, Assessment]:
    """Return the workspace that is looked at and what was found; `InputError` where it is out of reach."""
    from hexdbb.workspace import assess, require_reach, suggested_workspace

    with message_console().status(f"{origin}: workspace"):
        workspace = wanted or machine.workspace or suggested_workspace(machine)
        require_reach(machine, workspace, origin)
        return workspace, assess(machine, workspace)


def check_picture(path: Path) -> None:
    """Check that a picture may be written under a name."""
    from hexdbb.plots.saving import FORMATS

    if path.suffix not in FORMATS:
        raise InputError(f"{path}: not a format of pictures (expected {' or '.join(FORMATS)})")
    refuse_existing(path, overwrite=True)


def draw(machine: MachineFile, workspace: Workspace, path: Path) -> None:
    """Write the picture of a machine."""
    from hexdbb.plots.machine import machine_figure
    from hexdbb.plots.saving import save_figure
    from hexdbb.workspace import level_map

    with message_console().status(f"{path}: picture"):
        figure = machine_figure(machine, workspace, level_map(machine, workspace))
        (drawn,) = save_figure(figure, path.with_suffix(""), [path.suffix])
    say(f"{drawn}: picture written", err=True)


def _json(machine: MachineFile, found: Assessment) -> dict[str, object]:
    import math

    numbers = ("condition", "to_end_of_travel_mm", "to_min_gap_mm", "to_joint_limit_deg")
    return {
        "machine": machine.name,
        "workspace": found.workspace.model_dump(),
        "poses": found.poses,
        "reached": found.reached,
        **{name: value if math.isfinite(value := getattr(found, name)) else None for name in numbers},
        "worst": [asdict(each) for each in found.worst],
        "findings": list(found.findings),
    }
