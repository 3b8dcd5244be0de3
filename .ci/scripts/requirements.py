"""Print the requirements of pyproject.toml, which pip installs before the package itself."""

from __future__ import annotations

import tomllib
from pathlib import Path

PYPROJECT = Path(__file__).parents[2] / "pyproject.toml"


def requirements(pyproject: Path) -> list[str]:
    """Return all requirements of a pyproject.toml in the syntax of pip: build system, dependencies, every extra."""
    content = tomllib.loads(pyproject.read_text(encoding="utf-8"))
    project = content["project"]
    extras = [each for extra in project["optional-dependencies"].values() for each in extra]
    return [*content["build-system"]["requires"], *project["dependencies"], *extras]


if __name__ == "__main__":
    print("\n".join(requirements(PYPROJECT)))
