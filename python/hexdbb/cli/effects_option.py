"""The option --effects: a user's own effects beside the known ones. Only a file named here is ever run."""

from __future__ import annotations

from pathlib import Path

import click

from hexdbb.effects import UserEffect, load_effects

effects_option = click.option(
    "--effects",
    "effects_path",
    metavar="FILE.py",
    type=click.Path(path_type=Path),
    help="Python file that declares effects of your own; they stand beside the known ones. It is run.",
)


def own_effects(path: Path | None) -> list[UserEffect]:
    """Return the effects of the file named, none where none is.

    Raises
    ------
    InputError
        What `load_effects` refuses, with file and line.
    """
    return [] if path is None else load_effects(path)
