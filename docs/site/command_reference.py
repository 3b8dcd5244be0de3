"""Reference of the commands: one page each, made of click's own tree."""

from __future__ import annotations

import importlib
import textwrap
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path

from hexdbb.cli import COMMANDS

BAR = "| "
"""Before lines of a help text that click does not fill, as sphinx-click hands them over."""
RUN = "hexdbb-run"


def write_pages(folder: Path) -> None:
    """Write a page for every command and their index into a folder.

    The names and their one-line descriptions are those of `hexdbb --help`.
    """
    (folder / "cli").mkdir(parents=True, exist_ok=True)
    run = importlib.import_module("hexdbb.cli.run").command
    described = {RUN: run.get_short_help_str(200), **{f"hexdbb {name}": text for name, text in COMMANDS.items()}}
    for title in described:
        module = "run" if title == RUN else title.removeprefix("hexdbb ").replace("-", "_")
        (folder / "cli" / f"{_file(title)}.rst").write_text(_page(title, module), encoding="utf-8")
    rows = "".join(f"   * - :doc:`{title} <cli/{_file(title)}>`\n     - {text}\n" for title, text in described.items())
    entries = "".join(f"   cli/{_file(title)}\n" for title in described)
    index = f"Commands\n========\n\n.. list-table::\n\n{rows}\n.. toctree::\n   :hidden:\n\n{entries}"
    (folder / "cli.rst").write_text(index, encoding="utf-8")


def show_examples_as_code(app: object, context: object, lines: list[str]) -> None:
    """Replace the lines that a help text has as they stand (examples, tables) by blocks of code, in place."""
    lines[:] = [line for bar, part in groupby(lines, _is_bar) for line in (_block([*part]) if bar else part)]


def _is_bar(line: str) -> bool:
    return line.startswith(BAR)


def _block(lines: list[str]) -> Iterator[str]:
    bare = [line.removeprefix(BAR) for line in lines]
    if bare[0].endswith(":"):
        yield from (bare.pop(0), "")
    if bare:
        language = "console" if bare[0].split()[0].startswith("hexdbb") else "none"
        yield from (f".. code-block:: {language}", "")
        yield from textwrap.indent(textwrap.dedent("\n".join(bare)), "   ").splitlines()
    yield ""


def _file(title: str) -> str:
    return title.replace(" ", "-")


def _page(title: str, module: str) -> str:
    return f".. click:: hexdbb.cli.{module}:command\n   :prog: {title}\n   :nested: full\n"
