"""What a command prints, as a string: for `print(result)` in Python."""

from __future__ import annotations

import io

from rich.console import Console, RenderableType

WIDTH = 110
"""Characters a line: commands print as wide where they are redirected."""


def plain_text(shown: RenderableType) -> str:
    """Return a renderable as text without colours, lines ended by a newline but for the last."""
    lines = io.StringIO()
    Console(file=lines, width=WIDTH, highlight=False, emoji=False, color_system=None).print(shown, soft_wrap=True)
    return lines.getvalue().rstrip("\n")
