"""Data files shipped with the package, and the shipped machine's file, the only place of its numbers."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

SHIPPED_MACHINE = "sp120"
"""Name of the shipped machine in plans and measurements."""


def shipped(*parts: str) -> Path:
    """Return the path of a data file shipped with the package."""
    return Path(__file__).parents[1].joinpath("data", *parts)


@cache
def shipped_can() -> dict[str, Any]:
    """Return the `[can]` section of the shipped machine file, whose values are the defaults of every machine file."""
    text = shipped(f"{SHIPPED_MACHINE}.toml").read_text(encoding="utf-8")
    section: dict[str, Any] = tomllib.loads(text)["can"]
    return section
