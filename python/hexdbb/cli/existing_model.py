"""A model file that must be there already."""

from __future__ import annotations

from pathlib import Path

from hexdbb.errors import InputError
from hexdbb.model import Model, load_model


def existing_model(path: Path) -> Model:
    """Read a model file.

    Raises
    ------
    InputError
        Where there is none, saying which command makes one; what `load_model` refuses.
    """
    if not path.exists():
        raise InputError(f"{path}: no such model (expected a model file, as `hexdbb diagnose RECORD -m {path}` makes)")
    return load_model(path)
