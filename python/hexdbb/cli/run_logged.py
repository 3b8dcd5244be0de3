"""`hexdbb-run --log`: the record goes into the machine's logbook when the run has ended."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from hexdbb.errors import HexdbbError, RunError
from hexdbb.machine import MachineFile
from hexdbb.record import Record

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]

log_option: Decorator = click.option(
    "--log",
    metavar="FOLDER",
    type=click.Path(path_type=Path),
    help="File the record in the machine's logbook in FOLDER too, which is made where there is none (hexdbb log).",
)


def filing_in(folder: Path, machine: MachineFile) -> Callable[[Record], str]:
    """Return the function that files a record, and says so.

    Parameters
    ----------
    folder : Path
        Of the logbook.
    machine : MachineFile
        To be driven: a logbook of another one is refused before anything moves.

    Raises
    ------
    InputError
        The folder is none of a logbook, or that of another machine.
    """
    from hexdbb.logbook import SHORT, Logbook  # models take half a second to import

    logbook = Logbook.of(folder, machine)
    logbook.require(machine, "the plan's machine" if machine.path is None else str(machine.path))

    def file(record: Record) -> str:
        """File a record; `RunError` where it cannot be, which leaves the record where it is."""
        assert record.path is not None
        try:
            entry = logbook.add(record.path).entry
        except HexdbbError as error:
            raise RunError(
                f"{record.path} is whole, but not in the logbook: {error}; later: hexdbb log add {folder} {record.path}"
            ) from None
        return f"filed in {folder}: record {entry.sha256[:SHORT]}"

    return file
