"""Text for people: what a command prints as a string, and characters that a terminal would obey shown as escapes."""

from __future__ import annotations

import io
import unicodedata
from collections.abc import Iterable
from typing import Any

from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment

WIDTH = 110
"""Characters a line: commands print as wide where they are redirected."""
OBEYED = {"Cc", "Cf", "Cs", "Zl", "Zp"}
"""Categories of Unicode that a terminal or an editor obeys instead of showing: control and format characters (among
them those that reverse the direction of text), halves of characters, line and paragraph separators."""


def printable(text: str, kept: str = "\n\t") -> str:
    """Return text with the escape sequence of every character of `OBEYED` but those `kept` in its place."""
    if text.isprintable():
        return text
    return "".join(
        each if each in kept or unicodedata.category(each) not in OBEYED else each.encode("unicode_escape").decode()
        for each in text
    )


class TextConsole(Console):
    """Console that shows the control characters of texts as escapes, and texts with brackets as they are."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**{"markup": False, "emoji": False, **options})

    def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterable[Segment]:
        """See `rich.console.Console.render`; colours are added to these segments later."""
        for segment in super().render(renderable, options):
            yield segment if segment.control else segment._replace(text=printable(segment.text))


def plain_text(shown: RenderableType) -> str:
    """Return a renderable as text without colours, lines ended by a newline but for the last."""
    lines = io.StringIO()
    TextConsole(file=lines, width=WIDTH, highlight=False, color_system=None).print(shown, soft_wrap=True)
    return lines.getvalue().rstrip("\n")
