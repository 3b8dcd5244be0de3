"""`hexdbb convert`: records between file formats, and readings of other programs to records."""

from __future__ import annotations

from pathlib import Path

import click

from hexdbb.cli.consoles import message_console, say
from hexdbb.cli.import_options import OF_CONVERT, import_options, wanted_mapping
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing
from hexdbb.importing import Mapping, load_mapping, read_measured, save_mapping
from hexdbb.record import write_record


@click.command(name="convert")
@click.argument("source", metavar="IN", type=click.Path(path_type=Path))
@click.argument("target", metavar="OUT", type=click.Path(path_type=Path))
@import_options(OF_CONVERT)
@click.option(
    "--save-mapping",
    "mapping_path",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="Write what the options say as a mapping file; NAME.toml beside NAME.csv is found by itself the next time.",
)
@click.option("--overwrite", is_flag=True, help="Replace OUT (and the mapping file) if it exists.")
def command(source: Path, target: Path, mapping_path: Path | None, overwrite: bool) -> None:
    """Convert a record between its file formats, or readings of another program to a record.

    IN is a record, a delimited text (.csv, .txt, .tsv, .dat), an Excel sheet (.xlsx) or a Renishaw test (.b5r). Of a
    text or sheet delimiter, decimal mark, encoding, headings and units are detected, and printed in one line on stderr;
    options replace what is detected wrongly. What the file does not say is asked for: the plan that was driven, the
    circle, a unit that no heading states. Readings without slider positions get those of the nominal machine on the
    plan's circle, which the record states.

    OUT is a Parquet record (.parquet), an Excel workbook (.xlsx), or the text form: NAME.csv with NAME.toml and
    NAME.machine.toml beside it.

    Quantities of --column and --unit: angle, reading, reading_ccw, reading_cw, direction, time, feed, circle, sweep,
    lap, temperature, s1 to s6. An empty NAME leaves the file's column out.

    \b
    Examples:
      hexdbb convert demo.parquet demo.csv
      hexdbb convert measured.csv measured.parquet
      hexdbb convert messung.csv messung.parquet --plan thesis --save-mapping messung.toml
      hexdbb convert tests.xlsx monday.parquet --plan plan.toml --circle 2 --sheet Monday --unit reading=um
      hexdbb convert test.b5r test.parquet --plan thesis --unit reading=um --start-angle 0 --arc 360
      hexdbb convert demo.parquet demo.xlsx
    """
    wanted = wanted_mapping() or Mapping()
    if mapping_path is not None:
        refuse_existing(mapping_path, overwrite)
        _require_apart(mapping_path, source, target)
    messages = message_console()

    def tell(line: str) -> None:
        messages.print(line, markup=False, highlight=False, soft_wrap=True)

    with messages.status(f"{source} to {target}"):
        record = read_measured(source, wanted, tell)
        write_record(record, target, overwrite, checked=True)
    if mapping_path is not None:
        beside = source.with_suffix(".toml")
        is_known = beside == mapping_path and beside.is_file()
        save_mapping(wanted.over(load_mapping(beside)) if is_known else wanted, mapping_path, overwrite)
    say(f"{target}: {len(record)} samples, {len(record.sweeps())} sweeps")


def _require_apart(mapping: Path, source: Path, target: Path) -> None:
    """Check that a mapping file replaces nothing else that is read or written."""
    others = {
        source,
        target,
        *(target.with_suffix(end) for end in (".toml", ".machine.toml") if target.suffix == ".csv"),
    }
    if mapping in others:
        raise InputError(f"--save-mapping {mapping}: is a file of the record (expected another name)")
