"""`hexdbb report`: one file to hand over, as a page or on paper."""

from __future__ import annotations

import json
from pathlib import Path

import click

from hexdbb.cli.consoles import message_console, output_console, say
from hexdbb.cli.effects_option import effects_option
from hexdbb.cli.existing_model import existing_model
from hexdbb.cli.read_samples import read_samples
from hexdbb.cli.shared_options import json_option, model_option, records_argument
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing


@click.command("report")
@records_argument
@model_option("Model file, as diagnose makes.")
@effects_option
@click.option(
    "-o",
    "--output",
    metavar="FILE.html",
    type=click.Path(path_type=Path),
    help="Page to write; NAME-report.html beside the last record where not given.",
)
@click.option("--pdf", "pdf", metavar="FILE.pdf", type=click.Path(path_type=Path), help="Write it on A4 too.")
@click.option(
    "--tolerance",
    "tolerances",
    metavar="Q=UM",
    multiple=True,
    help="Largest G, G(b) or F that passes, µm: --tolerance 'G(b)=25,F=20'; repeatable; before those of the machine"
    " file.",
)
@click.option("--no-cause", is_flag=True, help="Do not look for the likely cause: some seconds less.")
@click.option("--overwrite", is_flag=True, help="Replace existing files.")
@json_option
def command(
    records: tuple[Path, ...],
    model_path: Path,
    effects_path: Path | None,
    output: Path | None,
    pdf: Path | None,
    tolerances: tuple[str, ...],
    no_cause: bool,
    overwrite: bool,
    as_json: bool,
) -> None:
    """Write the report of a circular test: one page that holds all it shows.

    The verdict in one sentence; test conditions; pass or fail; how the error fell; every error's part in the circular
    deviation, ranked; each circle with its ISO 230-4 quantities; what the rest follows; values; what cannot be
    identified; what to measure next. The page needs no network and no program but a browser. Several records, the
    earliest first, are compared: before and after.

    RECORD is a Parquet record, or a text file, Excel sheet or Renishaw test of another program.

    \b
    Examples:
      hexdbb report today.parquet -m model.toml -o report.html
      hexdbb report today.parquet -m model.toml -o report.html --tolerance "G(b)=25" --pdf report.pdf
      hexdbb report before.parquet after.parquet -m model.toml -o change.html
    """
    from hexdbb.reporting import make_report, parse_tolerance, require_writer, write_page, write_pdf

    page = output or records[-1].with_name(f"{records[-1].stem}-report.html")
    _require_suffix(page, ".html", "-o")
    refuse_existing(page, overwrite)
    if pdf is not None:
        _require_suffix(pdf, ".pdf", "--pdf")
        refuse_existing(pdf, overwrite)
        require_writer()
    tolerance = parse_tolerance(tolerances)
    model = existing_model(model_path, effects_path)
    messages = message_console()
    with messages.status("reading records") as status:
        samples = read_samples(records, messages)
        found = make_report(samples, model, tolerance=tolerance, find_cause=not no_cause, progress=status.update)
        status.update("writing the page")
        write_page(found, page)
        if pdf is not None:
            status.update("laying out for paper")
            write_pdf(found, pdf)
    if as_json:
        say(json.dumps(found.to_json(), indent=2, allow_nan=False))
    else:
        output_console().print(found.verdict, markup=False, highlight=False, soft_wrap=True)
    written = f"{page}" if pdf is None else f"{page}, {pdf}"
    messages.print(f"report: {written}", markup=False, highlight=False, soft_wrap=True)


def _require_suffix(path: Path, suffix: str, option: str) -> None:
    if path.suffix != suffix:
        raise InputError(f"{option} {path}: suffix {path.suffix!r} (expected {suffix})")
