"""Arguments and options shared by several commands: records, model file, JSON."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import click
from rich.console import Console

from hexdbb.cli.import_options import OF_RECORDS, import_options

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]


def records_argument(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the argument RECORD..., and the options that say how files of other programs are read as records."""
    argument = click.argument("records", metavar="RECORD...", nargs=-1, required=True, type=click.Path(path_type=Path))
    return argument(import_options(OF_RECORDS)(command))


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


def stem_of(prefix: Path | None, default: Path) -> Path:
    """Return what the names of pictures begin with: a prefix, or the default name, in the prefix if it is a folder."""
    if prefix is None:
        return default
    return prefix / default.name if prefix.is_dir() else prefix


def model_option(help_text: str, required: bool = True) -> Decorator:
    """Return the option -m MODEL with a help text."""
    return click.option(
        "-m",
        "--model",
        "model_path",
        required=required,
        metavar="MODEL",
        type=click.Path(path_type=Path),
        help=help_text,
    )
