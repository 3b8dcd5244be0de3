"""`hexdbb convert`: a record from one file format to another."""

from __future__ import annotations

from pathlib import Path

import click

from hexdbb.cli.consoles import message_console, say
from hexdbb.record import read_record, write_record


@click.command(name="convert")
@click.argument("source", metavar="IN", type=click.Path(path_type=Path))
@click.argument("target", metavar="OUT", type=click.Path(path_type=Path))
@click.option("--overwrite", is_flag=True, help="Replace OUT if it exists.")
def command(source: Path, target: Path, overwrite: bool) -> None:
    """Convert a record between its file formats, chosen by suffix.

    A record is a Parquet file (.parquet). Its text form is NAME.csv with NAME.toml beside it; on writing, the machine
    file NAME.machine.toml is added.

    \b
    Examples:
      hexdbb convert demo.parquet demo.csv
      hexdbb convert measured.csv measured.parquet
    """
    with message_console().status(f"{source} to {target}"):
        record = read_record(source)
        write_record(record, target, overwrite, checked=True)
    say(f"{target}: {len(record)} samples, {len(record.sweeps())} sweeps")
