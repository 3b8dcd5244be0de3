"""`hexdbb recover`: the record of an interrupted capture from its journal."""

from __future__ import annotations

from pathlib import Path

import click
from rich.console import Console

from hexdbb.errors import InputError
from hexdbb.record import journal_path, recover, write_record


@click.command(name="recover")
@click.argument("journal", metavar="JOURNAL", type=click.Path(path_type=Path))
@click.option(
    "-o",
    "--output",
    metavar="RECORD",
    type=click.Path(path_type=Path),
    help="Record to write; default: JOURNAL without its suffix.",
)
@click.option("--overwrite", is_flag=True, help="Replace RECORD if it exists.")
def command(journal: Path, output: Path | None, overwrite: bool) -> None:
    """Write the record of an interrupted capture from its journal.

    The record is marked incomplete. It holds every sample up to one second or less before the interruption, or up to
    the first wrong one. The journal is kept; remove it once the record is good.

    \b
    Examples:
      hexdbb recover demo.parquet.journal
      hexdbb recover demo.parquet.journal -o saved.parquet
    """
    if output is None:
        output = journal.with_suffix("")
        if journal_path(output) != journal:
            raise InputError(f"{journal}: not named RECORD.journal (expected -o RECORD with such a name)")
    with Console(stderr=True).status(f"{journal} to {output}"):
        record = recover(journal)
        write_record(record, output, overwrite, checked=True)
    last_s = record.columns["t_s"][-1]
    click.echo(f"{output}: {len(record)} samples, the last at {last_s:.3f} s, marked incomplete")
    click.echo(f"reason: {record.metadata['incomplete_because']}")
