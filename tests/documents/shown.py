"""Command blocks of a page: what a reader types, and what the page says is printed.

A block is fenced without a language. A line that begins with ``$ `` is a command, the lines up to the next one are
what it prints. In a block without ``$ `` every line that begins with a known command is one, its output not shown.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

FENCED = re.compile(r"^```(\w*)\n(.*?)^```$", flags=re.MULTILINE | re.DOTALL)
"""Language and lines of a block. Blocks of a language match too, so that none ends where another begins."""
TYPED = re.compile(r"^(?:hexdbb|hexdbb-run|make|python|\.|cmake|pip|cat|cd|source|git) ")


@dataclass(frozen=True)
class Shown:
    """One command of a page; `output` is None where the page does not say what it prints."""

    command: str
    output: tuple[str, ...] | None


def blocks(page: Path, language: str = "") -> list[str]:
    """Return the blocks of a page that are in a language, or in none."""
    return [text for named, text in FENCED.findall(page.read_text(encoding="utf-8")) if named == language]


def shown_commands(page: Path) -> list[Shown]:
    """Return the commands of a page in the order in which they stand."""
    return [each for block in blocks(page) for each in _of_block(block.splitlines())]


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
