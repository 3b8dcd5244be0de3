"""What several commands ask for alike: records, a model file, JSON."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]

records_argument: Decorator = click.argument(
    "records", metavar="RECORD...", nargs=-1, required=True, type=click.Path(path_type=Path)
)
json_option: Decorator = click.option("--json", "as_json", is_flag=True, help="Print one JSON object on stdout.")


def model_option(words: str) -> Decorator:
    """Give the option -m MODEL, required; `words` are its help."""
    return click.option(
        "-m", "--model", "model_path", required=True, metavar="MODEL", type=click.Path(path_type=Path), help=words
    )
