"""Where commands print: tables on stdout, as wide as the terminal; lines of text; messages and progress on stderr.

The progress of a run is printed to a stream that may go away.
"""

from __future__ import annotations

import os
import sys
from typing import IO, Any, cast

import click
from rich.console import Console

from hexdbb.files.plain_text import WIDTH, TextConsole, printable

REDIRECTED_WIDTH = WIDTH
"""Limits the length of lines that can be wrapped, in characters, where stdout is not a terminal: rich would fold at its
default of 80, and the table of `hexdbb plan compare` is 103 wide. A table that needs more has it."""


def output_console() -> Console:
    """Return the console that a command prints its results to."""
    on_terminal = sys.stdout is not None and sys.stdout.isatty()  # None: closed by the shell (>&-)
    width = None if on_terminal else REDIRECTED_WIDTH
    return TextConsole(width=width, highlight=False, long_lines=not on_terminal)


def message_console() -> Console:
    """Return the console for messages and progress, on stderr."""
    return TextConsole(stderr=True, soft_wrap=True, highlight=False)


def say(text: str, err: bool = False, nl: bool = True) -> None:
    """Print text to stdout, or stderr, its control characters shown as escapes."""
    click.echo(printable(text), err=err, nl=nl)


def run_console() -> Console:
    """Return the console that a run prints its progress to; a terminal that is closed does not end the run."""
    stream = sys.stderr if sys.stderr is None else cast(IO[str], _Forgiving(sys.stderr))
    return TextConsole(file=stream, stderr=stream is None)


def drop(stream: IO[str]) -> None:
    """Send the rest of a stream to nowhere: unwritable, it would make the interpreter fail once more at its end."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, stream.fileno())
    os.close(nowhere)


def end_output() -> None:
    """Write what waits in stdout and stderr; where nobody reads it any more, drop it."""
    for stream in filter(None, (sys.stdout, sys.stderr)):  # None: closed by the shell
        try:
            stream.flush()
        except OSError:
            drop(stream)


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
