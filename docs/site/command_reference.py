"""Reference of the commands: one page each, made of click's own tree."""

from __future__ import annotations

import importlib
from pathlib import Path

from hexdbb.cli import COMMANDS

RUN = "hexdbb-run"


def write_pages(folder: Path) -> None:
    """Write a page for every command and their index into a folder.

    The names and their one-line descriptions are those of `hexdbb --help`.
    """
    (folder / "cli").mkdir(parents=True, exist_ok=True)
    run = importlib.import_module("hexdbb.cli.run").command
    described = {RUN: run.get_short_help_str(200), **{f"hexdbb {name}": text for name, text in COMMANDS.items()}}
    for title in described:
        module = "run" if title == RUN else title.removeprefix("hexdbb ")
        (folder / "cli" / f"{_file(title)}.rst").write_text(_page(title, module), encoding="utf-8")
    rows = "".join(f"   * - :doc:`{title} <cli/{_file(title)}>`\n     - {text}\n" for title, text in described.items())
    entries = "".join(f"   cli/{_file(title)}\n" for title in described)
    index = f"Commands\n========\n\n.. list-table::\n\n{rows}\n.. toctree::\n   :hidden:\n\n{entries}"
    (folder / "cli.rst").write_text(index, encoding="utf-8")


def _file(title: str) -> str:
    return title.replace(" ", "-")


def _page(title: str, module: str) -> str:
    line = "=" * len(title)
    return f"{title}\n{line}\n\n.. click:: hexdbb.cli.{module}:command\n   :prog: {title}\n   :nested: full\n"
