"""`hexdbb recover`: the record of an interrupted capture from its journal, or what is whole of a damaged record."""

from __future__ import annotations

from pathlib import Path

import click

from hexdbb.cli.consoles import message_console, say
from hexdbb.errors import InputError
from hexdbb.record import journal_path, recover, write_record


@click.command(name="recover")
@click.argument("source", metavar="FILE", type=click.Path(path_type=Path))
@click.option(
    "-o",
    "--output",
    metavar="RECORD",
    type=click.Path(path_type=Path),
    help="Record to write; default for a journal: its name without the suffix.",
)
@click.option("--overwrite", is_flag=True, help="Replace RECORD if it exists.")
def command(source: Path, output: Path | None, overwrite: bool) -> None:
    """Write the record of an interrupted capture from its journal, or what is whole of a damaged Parquet record.

    The record is marked incomplete. Of a journal it holds every sample up to one second or less before the
    interruption, or up to the first wrong one, without what is damaged; of a Parquet record all row groups whose
    required columns are whole. FILE is kept; remove it once the record is good.

    \b
    Examples:
      hexdbb recover demo.parquet.journal
      hexdbb recover demo.parquet.journal -o saved.parquet
      hexdbb recover damaged.parquet -o saved.parquet
    """
    if output is None:
        output = source.with_suffix("")
        if journal_path(output) != source:
            raise InputError(f"{source}: not named RECORD.journal (expected -o RECORD with such a name)")
    if output.exists() and source.exists() and output.samefile(source):
        raise InputError(f"{output}: is the file to recover (expected a new name: the original is kept)")
    with message_console().status(f"{source} to {output}"):
        record = recover(source)
        write_record(record, output, overwrite, checked=True)
    last_s = record.columns["t_s"][-1]
    say(f"{output}: {len(record)} samples, the last at {last_s:.3f} s, marked incomplete")
    say(f"reason: {record.metadata['incomplete_because']}")
