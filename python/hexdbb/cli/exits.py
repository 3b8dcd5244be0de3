"""End of a command: exit status 0 done, 1 did not succeed, 2 wrong use, 130 Ctrl-C; an error is one line on stderr."""

from __future__ import annotations

import sys
from contextlib import suppress
from typing import Any

import click

from hexdbb.cli.consoles import drop, end_output
from hexdbb.errors import HexdbbError, InterruptError
from hexdbb.files.plain_text import printable


class Program(click.Command):
    """Click command whose Ctrl-C is an error of hexdbb; click would print "Aborted!" and exit as after a failure."""

    def invoke(self, ctx: click.Context) -> Any:
        """See `click.Command.invoke`."""
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            raise InterruptError("interrupted") from None


def reports_errors(command: click.Command) -> None:
    """Run a click command as a program; report an error as one line and exit with its status."""
    try:
        command.main()
    except HexdbbError as error:
        _end(printable(str(error), kept=""), error.exit_status)
    except OSError as error:
        # Files are written by functions that raise HexdbbError: without a file it is the program's own output.
        if error.filename is None:
            drop(sys.stdout)
        _end(f"{error.filename or 'stdout'}: {unwritable(error)}", 1)
    finally:
        end_output()


def unwritable(error: OSError) -> str:
    """Return the reason why a stream or file cannot be written, as part of a message."""
    return f"cannot be written: {error.strerror or type(error).__name__}"


def _end(message: str, status: int) -> None:
    with suppress(OSError):
        click.echo(f"error: {message}", err=True)
    sys.exit(status)
