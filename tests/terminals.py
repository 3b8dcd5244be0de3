"""A terminal of some width, which a program called in this process prints to."""

from __future__ import annotations

import io
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout

import pytest

from hexdbb.cli import main


class Terminal(io.StringIO):
    """What a terminal shows of stdout."""

    def isatty(self) -> bool:
        return True


@contextmanager
def terminal(width: int, **variables: str) -> Iterator[Terminal]:
    """Let stdout be a terminal of `width` characters a line, with variables of the environment."""
    shown = Terminal()
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(shown):
        for name in ("NO_COLOR", "FORCE_COLOR", "TTY_COMPATIBLE", "TTY_INTERACTIVE"):
            patch.delenv(name, raising=False)
        for name, value in {"TERM": "xterm-256color", "COLUMNS": str(width), "LINES": "40", **variables}.items():
            patch.setenv(name, value)
        yield shown


def on_terminal(width: int, *words: object, **variables: str) -> str:
    """Return what `hexdbb` with some words shows on a terminal."""
    with pytest.MonkeyPatch.context() as patch, terminal(width, **variables) as shown:
        patch.setattr(sys, "argv", ["hexdbb", *map(str, words)])
        with pytest.raises(SystemExit) as end:
            main()
    assert not end.value.code, end.value.code
    return shown.getvalue()
