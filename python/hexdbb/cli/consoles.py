"""Console of command results: tables for people on stdout, as wide as the terminal."""

from __future__ import annotations

import sys

from rich.console import Console

from hexdbb.files.plain_text import WIDTH

REDIRECTED_WIDTH = WIDTH
"""Limits the line length, in characters, where stdout is not a terminal: rich would fold at its default of 80, and the
table of `hexdbb plan compare` is 103 wide."""


def output_console() -> Console:
    """Return the console that a command prints its results to."""
    return Console(width=None if sys.stdout.isatty() else REDIRECTED_WIDTH, highlight=False, emoji=False)
