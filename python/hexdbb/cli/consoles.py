"""Consoles: results for people on stdout, as wide as the terminal; progress of a run on stderr, which may go away."""

from __future__ import annotations

import os
import sys
from typing import IO, Any, cast

from rich.console import Console

from hexdbb.files.plain_text import WIDTH

REDIRECTED_WIDTH = WIDTH
"""Limits the line length, in characters, where stdout is not a terminal: rich would fold at its default of 80, and the
table of `hexdbb plan compare` is 103 wide."""


def output_console() -> Console:
    """Return the console that a command prints its results to."""
    return Console(width=None if sys.stdout.isatty() else REDIRECTED_WIDTH, highlight=False, emoji=False)


def run_console() -> Console:
    """Return the console that a run prints its progress to; a terminal that is closed does not end the run."""
    stream = sys.stderr if sys.stderr is None else cast(IO[str], _Forgiving(sys.stderr))
    return Console(file=stream, stderr=stream is None)


def drop_stdout() -> None:
    """Send the rest of stdout to nowhere: it cannot be written, and the interpreter would fail once more at its end."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())
    os.close(nowhere)


class _Forgiving:
    """A stream whose writing does not fail."""

    def __init__(self, stream: IO[str]) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        try:
            return self._stream.write(text)
        except OSError:
            return len(text)

    def flush(self) -> None:
        try:
            self._stream.flush()
        except OSError:
            return

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)
