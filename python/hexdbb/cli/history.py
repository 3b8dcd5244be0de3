"""`hexdbb history`: what was done to a model, step by step."""

from __future__ import annotations

import json
from pathlib import Path

import click

from hexdbb.cli.consoles import say
from hexdbb.cli.effects_option import effects_option
from hexdbb.cli.existing_model import existing_model
from hexdbb.cli.shared_options import json_option, model_option
from hexdbb.ledger import history


@click.command("history")
@model_option("Model file.")
@effects_option
@json_option
def command(model_path: Path, effects_path: Path | None, as_json: bool) -> None:
    """Print a model's ledger: each step, the effect, its size, and the error before and after.

    \b
    Examples:
      hexdbb history -m model.toml
      hexdbb history -m model.toml --json
    """
    found = history(existing_model(model_path, effects_path))
    say(json.dumps(found.to_json(), indent=2, allow_nan=False) if as_json else found.text)
