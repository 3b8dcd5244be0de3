"""Text for people: what a command prints as a string, and characters that a terminal would obey shown as escapes."""

from __future__ import annotations

import io
import unicodedata
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, cast

from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment
from rich.table import Table

from hexdbb.files.whole_tables import whole

if TYPE_CHECKING:
    from rich.status import Status

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
    """Console that shows control characters as escapes, texts with brackets as they are, and tables whole.

    Parameters
    ----------
    long_lines : bool
        A table wider than the console stays a table, as files and pipes want it; else it is printed in its long form.
    **options
        See `rich.console.Console`.
    """

    def __init__(self, *, long_lines: bool = False, **options: Any) -> None:
        super().__init__(**{"markup": False, "emoji": False, **options})
        self._long_lines = long_lines

    def print(self, *objects: Any, **options: Any) -> None:
        """See `rich.console.Console.print`; lines are never cut at the console's edge."""
        super().print(*objects, **{"crop": False, **options})

    def status(self, status: RenderableType, **options: Any) -> Status:
        """See `rich.console.Console.status`; away from a terminal nothing is shown, and nothing loaded to show it."""
        return super().status(status, **options) if self.is_terminal else cast("Status", _Unseen())

    def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterable[Segment]:
        """See `rich.console.Console.render`; colours are added to these segments later."""
        options = options or self.options
        for segment in self._segments(renderable, options):
            text = segment.text
            if segment.control or text.isprintable() or text == "\n":  # nearly all of them
                yield segment
            else:
                yield segment._replace(text=printable(text))

    def _segments(self, renderable: RenderableType, options: ConsoleOptions) -> Iterable[Segment]:
        # Without headings it is the layout of something else, such as a progress bar.
        if isinstance(renderable, Table) and renderable.show_header:
            for part in whole(renderable, self, options, self._long_lines):
                yield from super().render(part, options)
        else:
            yield from super().render(renderable, options)


class _Unseen:
    """A status that nobody sees, as far as commands use one."""

    def __enter__(self) -> _Unseen:
        return self

    def __exit__(self, *_: object) -> None:
        """Do nothing."""

    def update(self, *_: object, **__: object) -> None:
        """Do nothing."""


def plain_text(shown: RenderableType) -> str:
    """Return a renderable as text without colours, lines ended by a newline but for the last."""
    lines = io.StringIO()
    console = TextConsole(file=lines, width=WIDTH, highlight=False, color_system=None, long_lines=True)
    console.print(shown, soft_wrap=True)
    return lines.getvalue().rstrip("\n")


def capital(text: str) -> str:
    """Return a sentence with a capital letter."""
    return text[:1].upper() + text[1:]
