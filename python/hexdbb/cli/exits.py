"""End of a command: exit status 0 done, 1 did not succeed, 2 wrong use; an error is one line on stderr."""

from __future__ import annotations

import sys

import click

from hexdbb.errors import HexdbbError
from hexdbb.files.plain_text import printable


def reports_errors(command: click.Command) -> None:
    """Run a click command as a program; report an error of hexdbb as one line and exit with its status."""
    try:
        command.main()
    except HexdbbError as error:
        click.echo(f"error: {printable(str(error), kept='')}", err=True)
        sys.exit(error.exit_status)
