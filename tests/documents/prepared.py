"""What pages take for granted before their first command."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

Run = Callable[[str, Path], str]
ROOT = Path(__file__).parents[2]


def _readme(folder: Path, run: Run) -> None:
    """Write the hidden machine as `make demo` does."""
    (folder / "demo").mkdir()
    run(f"source {ROOT}/.ci/scripts/hidden_machine.sh && hidden_machine demo/hidden.toml", folder)


def _discovery(folder: Path, run: Run) -> None: ...


PREPARED: dict[str, Callable[[Path, Run], None]] = {"README.md": _readme}
