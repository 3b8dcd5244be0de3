"""A model file that must be there already."""

from __future__ import annotations

from pathlib import Path

from hexdbb.cli.effects_option import own_effects
from hexdbb.errors import InputError
from hexdbb.model import Model, load_model


def existing_model(path: Path, effects_path: Path | None = None) -> Model:
    """Read a model file, which may have the effects of the user's own that another file declares.

    Raises
    ------
    InputError
        Where there is none, saying which command makes one; what `load_model` and `own_effects` refuse.
    """
    if not path.exists():
        raise InputError(f"{path}: no such model (expected a model file, as `hexdbb diagnose RECORD -m {path}` makes)")
    return load_model(path, own_effects(effects_path))
