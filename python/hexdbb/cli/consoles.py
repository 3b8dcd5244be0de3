"""Where commands print: tables on stdout, as wide as the terminal; lines of text; messages on stderr."""

from __future__ import annotations

import sys

import click
from rich.console import Console

from hexdbb.files.plain_text import WIDTH, TextConsole, printable

REDIRECTED_WIDTH = WIDTH
"""Limits the line length, in characters, where stdout is not a terminal: rich would fold at its default of 80, and the
table of `hexdbb plan compare` is 103 wide."""


def output_console() -> Console:
    """Return the console that a command prints its results to."""
    return TextConsole(width=None if sys.stdout.isatty() else REDIRECTED_WIDTH, highlight=False)


def message_console() -> Console:
    """Return the console for messages and progress, on stderr."""
    return TextConsole(stderr=True, soft_wrap=True, highlight=False)


def say(text: str, err: bool = False, nl: bool = True) -> None:
    """Print text to stdout, or stderr, its control characters shown as escapes."""
    click.echo(printable(text), err=err, nl=nl)
