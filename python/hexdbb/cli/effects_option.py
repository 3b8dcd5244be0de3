"""The option --effects: a user's own effects beside the known ones. Only a file named here is ever run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from hexdbb.effects import UserEffect

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
    if path is None:
        return []
    from hexdbb.effects import load_effects  # only who names a file loads it

    return load_effects(path)
