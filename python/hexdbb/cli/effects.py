"""`hexdbb effects`: what effects there are, and the handbook of them."""

from __future__ import annotations

import json
from pathlib import Path

import click
from rich.table import Table

from hexdbb.cli.consoles import message_console, output_console, say
from hexdbb.effects import load_effects
from hexdbb.effects.handbook import effect_infos, shown_size


@click.group(invoke_without_command=True)
@click.option("--effects", "path", type=click.Path(path_type=Path), help="Python file with effects of your own.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object on stdout.")
@click.pass_context
def command(context: click.Context, path: Path | None, as_json: bool) -> None:
    """List the effects a model can have.

    \b
    Examples:
      hexdbb effects
      hexdbb effects --effects mine.py
      hexdbb effects handbook -o docs/effects
    """
    if context.invoked_subcommand is not None:
        return
    infos = effect_infos() + ([each.info() for each in load_effects(path)] if path is not None else [])
    if as_json:
        rows = [
            {
                "effect": info.name,
                "group": info.group,
                "element_kind": info.element_kind,
                "elements": list(info.elements),
                "parameters": [{"name": each.name, "unit": each.unit} for each in info.parameters],
                "ports": list(info.ports),
                "needs": list(info.needs),
                "physics": info.physics,
            }
            for info in infos
        ]
        say(json.dumps({"effects": rows}, indent=2))
        return
    table = Table("effect", "group", "elements", "parameters, prior standard deviation", "physics", box=None)
    for info in infos:
        sizes = "\n".join(f"{each.name} {shown_size(each)}" for each in info.parameters)
        elements = f"{len(info.elements)} x {info.element_kind}"
        table.add_row(info.name, info.group, elements, sizes, info.physics)
    output_console().print(table)


@command.command()
@click.option("-o", "--output", required=True, type=click.Path(path_type=Path), help="Folder to write to.")
def handbook(output: Path) -> None:
    """Write a page and a picture for every effect.

    \b
    Example:
      hexdbb effects handbook -o docs/effects
    """
    from hexdbb.effects.signature import write_handbook  # matplotlib takes a second to import

    with message_console().status("drawing every effect"):
        written = write_handbook(output)
    say(f"{output}: {len(written)} files", err=True)
