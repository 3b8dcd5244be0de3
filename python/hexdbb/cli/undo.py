"""`hexdbb undo`: undo the last step of a model."""

from __future__ import annotations

import json
from pathlib import Path

import click

from hexdbb.cli.consoles import say
from hexdbb.cli.effects_option import effects_option
from hexdbb.cli.existing_model import existing_model
from hexdbb.cli.shared_options import json_option, model_option
from hexdbb.files.atomic_file import refuse_existing
from hexdbb.ledger import undo
from hexdbb.ledger.json_form import UndoneJson, step_json
from hexdbb.ledger.words import deed
from hexdbb.model import save_model


@click.command("undo")
@model_option("Model file; its last step is undone.")
@effects_option
@json_option
def command(model_path: Path, effects_path: Path | None, as_json: bool) -> None:
    """Undo the last step of a model: a diagnosis, an effect added.

    The model's file keeps every earlier state, so undo can be repeated down to the first step.

    \b
    Examples:
      hexdbb undo -m model.toml
      hexdbb history -m model.toml
    """
    refuse_existing(model_path, overwrite=True)
    model = existing_model(model_path, effects_path)
    earlier = undo(model)
    save_model(earlier, model_path)
    last = model.ledger[-1]
    if as_json:
        undone = UndoneJson(step_json(last), len(earlier.ledger))
        say(json.dumps(undone.to_json(), indent=2, allow_nan=False))
        return
    say(f"undone: step {last.step}, which {deed(last)}")
    say(f"{len(earlier.ledger)} step{'' if len(earlier.ledger) == 1 else 's'} left in the ledger")
