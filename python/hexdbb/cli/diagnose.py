"""`hexdbb diagnose`: fit a model's effects to records and say what is known."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import click
import numpy as np
from rich.console import Console
from rich.table import Table

from hexdbb.cli.consoles import output_console
from hexdbb.cli.effects_option import effects_option, own_effects
from hexdbb.cli.shared_options import json_option, model_option, records_argument
from hexdbb.diagnosis import Diagnosis, diagnose
from hexdbb.diagnosis.place_uncertainty import place_uncertainty
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing
from hexdbb.identifiability import minimal_set, record_sensitivity
from hexdbb.model import Model, load_model, new_model, parse_selection, save_model
from hexdbb.record import Record, read_record
from hexdbb.samples import knowing
from hexdbb.units import shown_factor, shown_unit

TOLD = 1e-4
"""A record's path leaves its circles by what the servos lag: what only that tells is not worth a value."""


@click.command()
@records_argument
@model_option("Model file; made from the record's machine and the thesis' geometric errors where there is none yet.")
@effects_option
@click.option("--free", "free", help="Effects to fit, as leg_length,slider_offset:2; the machine's others are held.")
@click.option("--fix", "fix", help="Effects or elements to hold, as guideway_translation:3,bar_length.")
@click.option("--minimal", is_flag=True, help="Fit as many errors as the readings tell (pivoted QR), hold the rest.")
@click.option("--robust", is_flag=True, help="Let readings far off (a gauge glitch) count less.")
@json_option
def command(
    records: tuple[Path, ...],
    model_path: Path,
    effects_path: Path | None,
    free: str | None,
    fix: str | None,
    minimal: bool,
    robust: bool,
    as_json: bool,
) -> None:
    """Fit the free effects of a model to RECORD... (.parquet or .csv) and write the values into the model file.

    \b
    Examples:
      hexdbb diagnose demo.parquet -m demo-model.toml
      hexdbb diagnose monday.parquet tuesday.csv -m model.toml --json
      hexdbb diagnose monday.parquet -m model.toml --minimal
      hexdbb diagnose monday.parquet -m model.toml --effects mine.py
      hexdbb diagnose monday.parquet -m model.toml --free leg_length,slider_offset --fix leg_length:6 --robust
    """
    refuse_existing(model_path, overwrite=True)
    messages = Console(stderr=True, soft_wrap=True, highlight=False)
    with messages.status("reading records"):
        read = [read_record(path) for path in records]
    own = own_effects(effects_path)
    model = load_model(model_path, own) if model_path.exists() else _model_of(read[0], model_path, messages)
    usual = knowing(model, read).free
    model = choose_free(model, free, fix)
    if minimal:
        model = hold_redundant(read, model)
    with messages.status(f"fitting {int(model.free.sum())} values to {sum(map(_rows, read)):,} readings"):
        found = diagnose(read, model, robust=robust)
        circle = read[0].circles[0]
        places = place_uncertainty(found, circle, read[0].mount(circle.mount).cup_mm)
    save_model(found.model.with_free(usual), model_path)
    if as_json:
        place = {"place_sigma_um": {"median": places.median_um, "worst": places.worst_um}}
        click.echo(json.dumps({**found.to_json(), **place}, indent=2))
    else:
        console = output_console()
        print_diagnosis(found, console)
        console.print(
            f"the ball's place over the workspace is known to {places.median_um:.2f} um (median),"
            f" {places.worst_um:.2f} um (worst) at one sigma, a rigid shift of the base aside",
            soft_wrap=True,
        )
    messages.print(f"{model_path}: values written")


def choose_free(model: Model, free: str | None, fix: str | None) -> Model:
    """Give the model with the values free that --free and --fix leave so.

    --free holds the machine's other effects; unknowns of the set-up stay as they are in the model unless named.

    Raises
    ------
    InputError
        Where the two contradict one another, or name what is not in the model.
    """
    chosen = model.free
    if free is not None:
        named = parse_selection(free, model, "--free")
        chosen = named | (chosen & np.array([each.is_set_up for each in model.parameters()]))
    if fix is not None:
        held = parse_selection(fix, model, "--fix")
        if free is not None and not (parse_selection(free, model, "--free") & ~held).any():
            raise InputError(f'--free "{free}" and --fix "{fix}" leave nothing to fit (expected one value at least)')
        chosen = chosen & ~held
    return model.with_free(chosen)


def hold_redundant(records: Sequence[Record], model: Model) -> Model:
    """Hold at zero what the readings cannot tell from the rest, so that the fitted values are known on their own."""
    known = knowing(model, records)
    _, held = minimal_set(record_sensitivity(records, known), TOLD)
    names = {each.label for each in held}
    redundant = np.array([each.label in names for each in known.parameters()])
    values = np.where(redundant, 0.0, known.values)
    told = np.concatenate([term.identifiable for term in known.terms]) & ~redundant
    return known.with_values(values, np.where(redundant, np.nan, known.sigma), told).with_free(known.free & ~redundant)


def print_diagnosis(found: Diagnosis, console: Console) -> None:
    """Print a diagnosis for people: the fall of the error, values and uncertainties, what cannot be known."""
    console.print(
        f"reading error {found.rms_before_um:.2f} um -> {found.rms_after_um:.2f} um RMS"
        f" (noise {found.noise.sigma_mm * 1e3:.2f} um, from {_source(found)})",
        highlight=False,
    )
    if found.held_out is not None:
        console.print(
            f"circles left out of the fit: {found.held_out.before_um:.2f} um -> {found.held_out.after_um:.2f} um RMS",
            highlight=False,
        )
    console.print(
        f"rank {found.rank} of {_machine_values(found.model)} errors of the machine (set-up unknowns taken out),"
        f" condition {found.condition:.0f}, {found.iterations} iterations",
        highlight=False,
    )
    console.print(_values_table(found.model))
    console.print(
        "~: known only in combination with others; the value shown is the smallest that explains the readings."
    )
    if found.unidentifiable:
        console.print("\nWhat these readings cannot tell:")
        for sentence in found.unidentifiable:
            console.print(f"  {sentence}", highlight=False, soft_wrap=True)
    for warning in found.warnings:
        console.print(f"warning: {warning}", style="yellow", highlight=False, soft_wrap=True)


def _values_table(model: Model) -> Table:
    table = Table(box=None, header_style="bold", pad_edge=False)
    for name in ("effect", "element", "parameter"):
        table.add_column(name)
    for name in ("value", "± 1 sigma"):
        table.add_column(name, justify="right")
    table.add_column("unit")
    index = 0
    parameters = model.parameters()
    for term in model.terms:
        shown = False
        for place, value in enumerate(term.values):
            each = parameters[index]
            if not term.free[place] and not value:
                index += 1
                continue
            factor = shown_factor(each.unit)
            sigma = f"{term.sigma[place] * factor:.2f}" if term.identifiable[place] else "~"
            sigma = sigma if term.free[place] else "held"
            name = "" if shown else each.effect
            shown = True
            table.add_row(name, each.element, each.name, f"{value * factor:.2f}", sigma, shown_unit(each.unit))
            index += 1
    return table


def _model_of(record: Record, path: Path, messages: Console) -> Model:
    messages.print(f"{path}: new model of {record.machine.name} with the thesis' geometric errors")
    return new_model(record.machine)


def _source(found: Diagnosis) -> str:
    return {"stated": "the gauge's statement", "roughness": "the readings' roughness"}.get(
        found.noise.source, found.noise.source
    )


def _machine_values(model: Model) -> int:
    return sum(not each.is_set_up for each, free in zip(model.parameters(), model.free, strict=True) if free)


def _rows(record: Record) -> int:
    return len(record.columns["t_s"])
