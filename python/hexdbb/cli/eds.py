"""`hexdbb eds`: whether drives and gauges can run the test, by their EDS files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Literal

import click
from rich.box import SIMPLE_HEAD
from rich.table import Table

from hexdbb.capture.eds import read_eds
from hexdbb.capture.fitness import Fitness, examine
from hexdbb.capture.json_form import eds_check_json
from hexdbb.cli.consoles import output_console
from hexdbb.machine import load_machine, shipped_machine


@click.group("eds")
def command() -> None:
    """Examine EDS files of drives and gauges.

    \b
    Examples:
      hexdbb eds check drive.eds gauge.eds
      hexdbb eds check drive.dcf --json
    """


@command.command("check", short_help="whether a device can run the test, and what it lacks")
@click.argument("files", metavar="FILE...", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option(
    "--as",
    "device",
    type=click.Choice(["drive", "gauge"]),
    help="What the device is to be; default: what its device type (object 1000h) says.",
)
@click.option(
    "--machine", "machine_path", type=click.Path(path_type=Path), help="Machine file; default: the shipped one."
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def check(
    files: tuple[Path, ...], device: Literal["drive", "gauge"] | None, machine_path: Path | None, as_json: bool
) -> None:
    """Check whether devices can run the test, by their EDS or DCF files.

    Every object is listed that the test needs and the device lacks, or that no PDO can hold, with what that means. The
    exit status is 1 if a device cannot run the test. Nothing is sent: what a device answers is checked before motion.

    \b
    Examples:
      hexdbb eds check drive.eds gauge.eds
      hexdbb eds check drive.dcf --as drive --json
    """
    machine = load_machine(machine_path) if machine_path is not None else shipped_machine()
    examined = {path: examine(read_eds(path), machine, machine.can_setup.cycle_s, device) for path in files}
    if as_json:
        click.echo(json.dumps(eds_check_json(examined).to_json(), indent=2))
    else:
        for path, fitness in examined.items():
            _print(path, fitness)
    if not all(fitness.usable for fitness in examined.values()):
        click.get_current_context().exit(1)


def _print(path: Path, fitness: Fitness) -> None:
    can = "can run the test" if fitness.usable else "cannot run the test"
    lacking = "" if fitness.findings else ": it has every object"
    click.echo(f"{path}: {fitness.device}, {can}{lacking}")
    if not fitness.findings:
        return
    table = Table("object", "line", "", "found", "what that means", box=SIMPLE_HEAD)
    for each in fitness.findings:
        line = "" if each.line is None else str(each.line)
        table.add_row(each.place, line, each.level.value, each.what, each.consequence)
    output_console().print(table)
