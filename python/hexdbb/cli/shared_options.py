"""Arguments and options shared by several commands: records, model file, JSON."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import click
from rich.console import Console

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]

records_argument: Decorator = click.argument(
    "records", metavar="RECORD...", nargs=-1, required=True, type=click.Path(path_type=Path)
)
json_option: Decorator = click.option("--json", "as_json", is_flag=True, help="Print one JSON object on stdout.")


plot_option: Decorator = click.option(
    "--plot",
    "folder",
    metavar="FOLDER",
    type=click.Path(path_type=Path),
    help="Write pictures into FOLDER (PNG and SVG), which is made if needed; existing ones are replaced.",
)


def print_pictures(written: Sequence[Path], messages: Console) -> None:
    """Print the names of pictures written."""
    names = ", ".join(map(str, written))
    messages.print(f"pictures: {names}", markup=False, highlight=False, soft_wrap=True)


def model_option(help_text: str) -> Decorator:
    """Return the required option -m MODEL with a help text."""
    return click.option(
        "-m", "--model", "model_path", required=True, metavar="MODEL", type=click.Path(path_type=Path), help=help_text
    )
