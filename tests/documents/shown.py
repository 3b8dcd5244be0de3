"""Command blocks of a page: what a reader types, and what the page says is printed.

A block is fenced without a language. A line that begins with ``$ `` is a command, the lines up to the next one are
what it prints. In a block without ``$ `` every line that begins with a known command is one, its output not shown.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

BLOCK = re.compile(r"^```\n(.*?)^```$", flags=re.MULTILINE | re.DOTALL)
TYPED = re.compile(r"^(?:hexdbb|hexdbb-run|make|python|\.|cmake|pip|cat|cd|source|git) ")


@dataclass(frozen=True)
class Shown:
    """One command of a page; `output` is None where the page does not say what it prints."""

    command: str
    output: tuple[str, ...] | None


def shown_commands(page: Path) -> list[Shown]:
    """Return the commands of a page in the order in which they stand."""
    text = page.read_text(encoding="utf-8")
    return [each for block in BLOCK.findall(text) for each in _of_block(block.splitlines())]


def _of_block(lines: list[str]) -> Iterator[Shown]:
    if not any(line.startswith("$ ") for line in lines):
        yield from (Shown(line, None) for line in lines if TYPED.match(line))
        return
    command, output = None, []
    for line in [*lines, "$ "]:
        if not line.startswith("$ "):
            output.append(line)
            continue
        if command is not None:
            yield Shown(command, tuple(output))
        command, output = line[2:], []
