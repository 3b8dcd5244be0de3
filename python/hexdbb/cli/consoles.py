"""Where commands print: tables for people to stdout, as wide as the terminal, or wide enough where redirected."""

from __future__ import annotations

import sys

from rich.console import Console

REDIRECTED_WIDTH = 110
"""Characters per line where stdout is no terminal, so that a table in a file is not folded."""


def output_console() -> Console:
    """Give the console of a command's results."""
    return Console(width=None if sys.stdout.isatty() else REDIRECTED_WIDTH, highlight=False)
