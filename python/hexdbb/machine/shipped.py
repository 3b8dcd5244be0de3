"""Files shipped with the package, by their names; the shipped machine's file is the only place of its numbers."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

from hexdbb.errors import InputError

SHIPPED_MACHINE = "sp120"
"""Name of the shipped machine in plans and measurements."""


def shipped(*parts: str) -> Path:
    """Return the path of a data file shipped with the package."""
    return Path(__file__).parents[1].joinpath("data", *parts)


def shipped_names(folder: str) -> list[str]:
    """Return the names of the TOML files of a folder shipped with the package, sorted."""
    return sorted(path.stem for path in shipped(folder).glob("*.toml"))


def shipped_or_own(name_or_path: Path | str, kind: str, folder: str) -> Path:
    """Return the path of a file that is named or shipped.

    Parameters
    ----------
    name_or_path : Path or str
    kind : str
        What it is, as the error says it.
    folder : str
        Where those shipped are.

    Raises
    ------
    InputError
        There is no such file, and none shipped is called so.
    """
    names, path = shipped_names(folder), Path(name_or_path)
    if str(name_or_path) in names:
        return shipped(folder, f"{name_or_path}.toml")
    if not path.exists():
        raise InputError(f"{path}: no such file (expected a {kind} file, or a shipped {kind}: {', '.join(names)})")
    return path


@cache
def shipped_can() -> dict[str, Any]:
    """Return the `[can]` section of the shipped machine file, whose values are the defaults of every machine file."""
    text = shipped(f"{SHIPPED_MACHINE}.toml").read_text(encoding="utf-8")
    section: dict[str, Any] = tomllib.loads(text)["can"]
    return section
