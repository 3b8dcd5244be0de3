"""Prints what pip has to install before the package itself: all requirements that pyproject.toml states."""

from __future__ import annotations

import tomllib
from pathlib import Path

PYPROJECT = Path(__file__).parents[2] / "pyproject.toml"


def requirements(pyproject: Path) -> list[str]:
    """Every requirement of a pyproject.toml, as pip reads them."""
    content = tomllib.loads(pyproject.read_text(encoding="utf-8"))
    project = content["project"]
    return [*content["build-system"]["requires"], *project["dependencies"], *project["optional-dependencies"]["dev"]]


if __name__ == "__main__":
    print("\n".join(requirements(PYPROJECT)))
