"""`hexdbb compare`: predicted against measured readings, in tables, JSON and polar plots."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import click
from rich.progress import Progress

from hexdbb.cli.consoles import message_console, output_console, say
from hexdbb.cli.effects_option import effects_option
from hexdbb.cli.existing_model import existing_model
from hexdbb.cli.imports_beside import DRAWING, imported_beside
from hexdbb.cli.read_samples import read_samples
from hexdbb.cli.shared_options import json_option, model_option, print_pictures, records_argument, stem_of
from hexdbb.comparison import Comparison, compare, compare_commanded
from hexdbb.comparison.tables import comparison_text
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PICTURES = {"first": (".png",), "all": (".png", ".pdf")}
"""Suffixes of the files that each choice of pages writes."""


@click.command("compare")
@records_argument
@model_option("Model file, as diagnose makes. Without it readings are compared with the commanded circles.", False)
@effects_option
@click.option(
    "--plot",
    "prefix",
    metavar="PREFIX",
    type=click.Path(path_type=Path),
    help="Write PREFIX.png (and PREFIX.pdf with --pages all); without it NAME-compare.* beside the first record.",
)
@click.option(
    "--pages",
    type=click.Choice(["first", "all"]),
    help="first: what matters first as one PNG (default); all: PREFIX.pdf beside it, which holds every circle, the "
    "predictors of the residual, both directions combined and harmonics on sheets of A4.",
)
@click.option("--no-plot", is_flag=True, help="Write no pictures.")
@click.option("--no-cause", is_flag=True, help="Do not look for the likely cause: some seconds less.")
@json_option
def command(
    records: tuple[Path, ...],
    model_path: Path | None,
    effects_path: Path | None,
    prefix: Path | None,
    pages: str | None,
    no_plot: bool,
    no_cause: bool,
    as_json: bool,
) -> None:
    """Compare measured readings with those a model predicts, or with the commanded circles.

    Prints first the likely cause of the residual (measured - predicted), where that is more than noise: a quick look by
    the analysis of hexdbb discover, which weighs it against all others. Then the quantities of ISO 230-4 for every
    circle, feed and direction; where the residual is largest and which circumstances are over-represented there; the
    part common to both directions and the part that reverses with direction; harmonics; predictors of the residual
    among the variables of the machine's state, those last that only go with the likely cause. The cup of a mount that
    the model does not know is fitted first, which is stated. Draws what matters first as one PNG: the circle of
    the largest residual with a stated magnification, all circles ranked, the best predictors; on request all in a PDF.

    Without a model the commanded circle takes the place of the prediction, about the cup as it stands in the circle's
    plane: ISO 230-4 quantities, harmonics and pictures need no model.

    RECORD is a Parquet record, or a text file, Excel sheet or Renishaw test of another program.

    \b
    Examples:
      hexdbb compare readings.csv --plan thesis
      hexdbb compare demo.parquet -m model.toml
      hexdbb compare monday.parquet tuesday.csv -m model.toml --plot week --pages all
      hexdbb compare demo.parquet -m model.toml --json --no-plot > comparison.json
    """
    stem = stem_of(prefix, records[0].with_name(f"{records[0].stem}-compare"))
    if prefix and no_plot:
        raise InputError(f"--plot {prefix} together with --no-plot: expected one of them")
    if pages and no_plot:
        raise InputError(f"--pages {pages} together with --no-plot: expected one of them")
    for suffix in () if no_plot else PICTURES[pages or "first"]:
        refuse_existing(stem.with_name(stem.name + suffix), overwrite=True)
    messages = message_console()
    with Progress(console=messages, transient=True, disable=not messages.is_terminal) as progress:
        beside = () if no_plot else DRAWING
        comparison = _comparison(records, model_path, effects_path, not no_cause, beside, progress)
        written = [] if no_plot else _draw(comparison, stem, pages == "all", progress)
    if as_json:
        say(json.dumps(comparison.to_json(), indent=2, allow_nan=False))
    else:
        output_console().print(comparison_text(comparison))
    if written:
        print_pictures(written, messages)


def _comparison(
    paths: tuple[Path, ...],
    model_path: Path | None,
    effects_path: Path | None,
    find_cause: bool,
    beside: tuple[str, ...],
    progress: Progress,
) -> Comparison:
    """Read records and compare them, while the libraries `beside` are imported."""
    if model_path is None and effects_path is not None:
        raise InputError(f"--effects {effects_path} without a model (expected -m MODEL with it)")
    model = None if model_path is None else existing_model(model_path, effects_path)
    progress.add_task("comparing", total=None)
    samples = read_samples(paths, progress.console)
    with imported_beside(beside):
        return compare_commanded(samples) if model is None else compare(samples, model, find_cause=find_cause)


def _draw(comparison: Comparison, stem: Path, is_all: bool, progress: Progress) -> list[Path]:
    from hexdbb.plots import comparison_pages, save_figure, save_pdf  # matplotlib takes a second to import

    pages = comparison_pages(comparison)
    task = progress.add_task("drawing", total=len(pages) if is_all else 1)

    first = pages[0].draw()

    def drawn() -> Iterator[Figure]:
        for page in pages:
            yield first if page is pages[0] else page.draw()
            progress.advance(task)

    written = save_figure(first, stem, [".png"])
    if is_all:
        written.append(save_pdf(drawn(), stem.with_name(f"{stem.name}.pdf")))
    return written
