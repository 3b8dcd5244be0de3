"""`hexdbb model new`: a model file with the named effects."""

from __future__ import annotations

from pathlib import Path

import click

from hexdbb.cli.consoles import say
from hexdbb.files.atomic_file import refuse_existing
from hexdbb.machine import SHIPPED_MACHINE, load_machine, shipped_machine
from hexdbb.model import new_model, save_model


@click.group()
def command() -> None:
    """Make model files."""


@command.command(short_help="a model with the named effects, all values zero")
@click.argument("machine")
@click.option("-o", "--output", required=True, type=click.Path(path_type=Path), help="Model file to write.")
@click.option("--effects", help="Comma-separated effects, all free; 'none' for the nominal machine.")
@click.option("--overwrite", is_flag=True, help="Replace an existing model file (the earlier version is kept).")
def new(machine: str, output: Path, effects: str | None, overwrite: bool) -> None:
    """Write a model of MACHINE (a machine file, or sp120 for the shipped one) with all values zero.

    Without --effects: the thesis' 33 geometric errors, cup position and ball offset free, bar length fixed.

    \b
    Examples:
      hexdbb model new machine.toml -o model.toml
      hexdbb model new sp120 -o nominal.toml --effects none
      hexdbb model new sp120 -o legs.toml --effects leg_length,cup_position
    """
    refuse_existing(output, overwrite)
    names = None if effects is None else [] if effects == "none" else [name.strip() for name in effects.split(",")]
    dimensions = shipped_machine() if machine == SHIPPED_MACHINE else load_machine(machine)
    model = new_model(dimensions, names)
    save_model(model, output)
    say(f"{output}: {len(model.terms)} effects, {len(model.values)} values", err=True)
