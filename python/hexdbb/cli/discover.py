"""`hexdbb discover`: whether anything is missing from a model, and which effect it is."""

from __future__ import annotations

import json
import shlex
from collections.abc import Iterable
from pathlib import Path

import click
from rich.console import Console

from hexdbb.cli.add import print_added
from hexdbb.cli.consoles import message_console, output_console, say
from hexdbb.cli.discovery_text import print_discovery
from hexdbb.cli.effects_option import effects_option
from hexdbb.cli.existing_model import existing_model
from hexdbb.cli.import_options import given_options
from hexdbb.cli.read_samples import read_samples
from hexdbb.cli.shared_options import json_option, model_option, plot_option, print_pictures, records_argument
from hexdbb.discovery import (
    AutoStep,
    Discovery,
    closing_sentence,
    discover,
    discover_all,
    draft_effect,
    require_draftable,
)
from hexdbb.files.atomic_file import refuse_existing, require_folder, write_text
from hexdbb.model import save_model


@click.command()
@records_argument
@model_option("Model file.")
@effects_option
@click.option("--auto", is_flag=True, help="Add what is missing to the model file, effect after effect.")
@click.option(
    "--forms",
    is_flag=True,
    help="With --auto, add functions too that describe how the machine's forms differ from those of the effects found:"
    " those by which circles left out are predicted better.",
)
@click.option(
    "--matters",
    "matters_um",
    metavar="UM",
    type=float,
    help="Unexplained RMS in µm below which nothing is missing that matters; a quarter of the noise, or a thousandth"
    " of the reading error that the model explains, where not given.",
)
@click.option("--known-only", is_flag=True, help="Try known effects alone, in a second: nothing is learned.")
@click.option(
    "--draft",
    "draft_path",
    metavar="FILE.py",
    type=click.Path(path_type=Path),
    help="Write the main cause, if it is learned, as an effect of your own, ready to be given its physics; else the"
    " best learned function that was tried.",
)
@click.option("--overwrite", is_flag=True, help="Replace an existing FILE.py.")
@plot_option
@json_option
def command(
    records: tuple[Path, ...],
    model_path: Path,
    effects_path: Path | None,
    auto: bool,
    forms: bool,
    matters_um: float | None,
    known_only: bool,
    draft_path: Path | None,
    overwrite: bool,
    folder: Path | None,
    as_json: bool,
) -> None:
    """Find out what a model lacks, from RECORD... (.parquet, .csv, .xlsx, .b5r).

    The verdict is one of: an effect; one of several that these readings cannot separate, with the circle that
    would; nothing that matters missing; something missing that no known effect explains, with where it acts and what
    it follows.

    The model file is not changed, unless by --auto: it adds what is known for sure and looks again, until nothing that
    matters is missing or the cause is not identified. An effect added earlier is taken out again where a later one
    makes it needless. With --forms it also adds what the forms of these effects leave.

    \b
    Examples:
      hexdbb discover today.parquet -m model.toml
      hexdbb discover monday.parquet tuesday.csv -m model.toml --json
      hexdbb discover today.parquet -m model.toml --effects mine.py
      hexdbb discover today.parquet -m model.toml --matters 0.5
      hexdbb discover today.parquet -m model.toml --known-only
      hexdbb discover today.parquet -m model.toml --auto
      hexdbb discover today.parquet -m model.toml --auto --forms
      hexdbb discover today.parquet -m model.toml --draft mine.py --plot pictures
    """
    if draft_path is not None:
        require_draftable(draft_path, overwrite)
    if folder is not None:
        require_folder(folder)
    if auto and known_only:
        raise click.UsageError("--known-only: --auto asks for all hypotheses (expected one of the two)")
    if forms and not auto:
        raise click.UsageError("--forms: nothing is added without --auto (expected both)")
    if auto:
        refuse_existing(model_path, overwrite=True)
    model = existing_model(model_path, effects_path)
    messages = message_console()
    steps: list[AutoStep] = []
    with messages.status("reading records") as status:
        samples = read_samples(records, messages)
        if auto:
            console = None if as_json else output_console()
            looks = discover_all(samples, model, progress=status.update, matters_um=matters_um, forms=forms)
            steps, found = _automatic(looks, model_path, console)
        else:
            found = discover(samples, model, progress=status.update, matters_um=matters_um, known_only=known_only)
    closing = closing_sentence(steps, found) if auto else None
    if as_json:
        shown = found.to_json([each.diagnosis for each in steps], closing)
        say(json.dumps(shown, indent=2, allow_nan=False))
    else:
        print_discovery(found, output_console(), shlex.join([*map(str, records), *given_options()]), model_path)
    if closing is not None and not as_json:
        output_console().print(closing, style="bold", highlight=False, soft_wrap=True)
    if folder is not None:
        _draw(found, folder, messages)
    if draft_path is not None:
        drafted = draft_effect(found)
        write_text(draft_path, drafted.source)
        messages.print(f"{draft_path}: draft of {drafted.sentence}", markup=False, highlight=False, soft_wrap=True)


def _draw(found: Discovery, folder: Path, messages: Console) -> None:
    from hexdbb.plots import discovery_pages, save_pages  # matplotlib takes a second to import

    with messages.status("drawing"):
        written = save_pages(discovery_pages(found), folder)
    print_pictures(written, messages)


def _automatic(
    looks: Iterable[AutoStep | Discovery], model_path: Path, console: Console | None
) -> tuple[list[AutoStep], Discovery]:
    """Add effects, the model file written and the step printed after each; return the steps and the last look."""
    steps: list[AutoStep] = []
    for each in looks:
        if isinstance(each, Discovery):
            return steps, each
        save_model(each.diagnosis.model, model_path)
        steps.append(each)
        if console is not None:
            removed = f"{each.choice} taken out again: what was added since explains the same"
            console.print(removed if each.what == "remove" else f"{each.choice} added", style="bold")
            print_added(each.diagnosis, console)
            console.print()
    raise AssertionError("the last look is always there")
