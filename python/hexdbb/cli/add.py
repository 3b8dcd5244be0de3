"""`hexdbb add`: one effect more in a model, everything fitted again, the fall of the error shown."""

from __future__ import annotations

import json
from pathlib import Path

import click
from rich.console import Console
from rich.table import Table

from hexdbb.cli.consoles import message_console, output_console, say
from hexdbb.cli.effects_option import effects_option
from hexdbb.cli.existing_model import existing_model
from hexdbb.cli.read_samples import read_samples
from hexdbb.cli.shared_options import json_option, model_option, records_argument
from hexdbb.diagnosis import Diagnosis
from hexdbb.diagnosis.learned_text import learned_parts
from hexdbb.discovery import require_usable_effects
from hexdbb.files.atomic_file import refuse_existing
from hexdbb.learned import Learned
from hexdbb.learned.places import is_learned
from hexdbb.ledger import add_effect
from hexdbb.ledger.json_form import added_json
from hexdbb.ledger.words import PLACES, arrow
from hexdbb.model import Choice, LedgerStep, save_model
from hexdbb.units import readable_unit


@click.command("add")
@click.argument("effect", metavar="EFFECT[:ELEMENT...]")
@records_argument
@model_option("Model file, as diagnose makes; it gains the effect.")
@effects_option
@click.option("--robust", is_flag=True, help="Let readings far off (a gauge glitch) count less.")
@json_option
def command(
    effect: str,
    records: tuple[Path, ...],
    model_path: Path,
    effects_path: Path | None,
    robust: bool,
    as_json: bool,
) -> None:
    """Add EFFECT, or some ELEMENTs of it, to a model, fit everything that is free to RECORD..., show the fall.

    The error before is that of the model without the effect, fitted to the same readings. Held-out circles are
    predicted by fits to the other circles. `hexdbb undo` takes the step back.

    \b
    Examples:
      hexdbb add backlash:4 -m model.toml today.parquet
      hexdbb add backlash:2:4 -m model.toml today.parquet yesterday.csv
      hexdbb add pitch_cyclic -m model.toml today.parquet --json
      hexdbb add learned:leg:5:turning_rate -m model.toml today.parquet
      hexdbb add my_dent -m model.toml today.parquet --effects mine.py
    """
    refuse_existing(model_path, overwrite=True)
    model = existing_model(model_path, effects_path)
    name = Choice.parse(effect).effect
    if is_learned(name):
        Learned.parse(name)
    else:
        model.info(name)  # an unknown name is refused before records are read
    messages = message_console()
    with messages.status("reading records"):
        samples = read_samples(records, messages)
    require_usable_effects(samples, model, [name])
    with messages.status(f"adding {effect}: fitting with and without it, then without the held-out circles"):
        found = add_effect(samples, model, effect, robust=robust)
    save_model(found.model, model_path)
    if as_json:
        say(json.dumps(added_json(found).to_json(), indent=2, allow_nan=False))
    else:
        print_added(found, output_console())
    messages.print(f"{model_path}: {effect} added (step {found.model.ledger[-1].step})", markup=False)


def print_added(found: Diagnosis, console: Console) -> None:
    """Print what an effect did to the error, and how large it was found to be."""
    step = found.model.ledger[-1]
    console.print(fall_line(step))
    if step.peak_to_valley_before_um is not None and step.peak_to_valley_after_um is not None:
        peaks = f"{step.peak_to_valley_before_um:.1f} µm -> {step.peak_to_valley_after_um:.1f} µm"
        console.print(f"peak to valley {peaks}, noise of one reading {found.noise.sigma_mm * 1e3:.2f} µm")
    table = Table(box=None, header_style="bold", pad_edge=False)
    for heading in ("effect", "element", "parameter"):
        table.add_column(heading)
    for heading in ("value", "± 1 sigma"):
        table.add_column(heading, justify="right")
    table.add_column("unit")
    for index, size in enumerate(step.sizes):
        places = PLACES.get(size.unit, ".4g")
        sigma = "~" if size.sigma is None else f"{size.sigma:{places}}"
        name = "" if index else step.effect
        table.add_row(name, size.element, size.name, f"{size.value:{places}}", sigma, readable_unit(size.unit))
    console.print(table)
    term = found.model.term(step.effect)
    if term is not None and term.learned is not None:
        for part in learned_parts(term):
            console.print(part, soft_wrap=True)
    if any(size.sigma is None for size in step.sizes):
        console.print("~: known only in combination with others.")
    for warning in found.warnings:
        console.print(f"warning: {warning}", style="yellow", markup=False, soft_wrap=True)


def fall_line(step: LedgerStep) -> str:
    """Return the fall in one line: ``6.83 µm -> 0.61 µm (held-out circles 6.90 -> 0.63)``."""
    line = f"{step.rms_before_um:.2f} µm -> {step.rms_after_um:.2f} µm"
    if step.heldout_before_um is None or step.heldout_after_um is None:
        return f"{line} (one circle only: none can be held out)"
    return f"{line} (held-out circles {arrow(step.heldout_before_um, step.heldout_after_um)})"
