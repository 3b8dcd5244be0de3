"""How commands end: one clear line on stderr, exit status 0 done, 1 did not succeed, 2 wrong use."""

from __future__ import annotations

import sys

import click

from hexdbb.errors import HexdbbError


def reports_errors(command: click.Command) -> None:
    """Run a click command as a program and turn every error of hexdbb into one line and its exit status."""
    try:
        command.main()
    except HexdbbError as error:
        click.echo(f"error: {error}", err=True)
        sys.exit(error.exit_status)
