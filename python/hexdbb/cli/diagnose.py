"""`hexdbb diagnose`: fit a model's effects to records; values, uncertainties, what is not identifiable."""

from __future__ import annotations

import json
from pathlib import Path

import click
import numpy as np
from rich.console import Console

from hexdbb.cli.consoles import message_console, output_console, say
from hexdbb.cli.effects_option import effects_option, own_effects
from hexdbb.cli.read_samples import read_samples
from hexdbb.cli.shared_options import json_option, model_option, plot_option, print_pictures, records_argument
from hexdbb.diagnosis import Diagnosis
from hexdbb.diagnosis.text import diagnosis_text
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing, require_folder
from hexdbb.identifiability import measured_sensitivity, minimal_set
from hexdbb.ledger import fit_model
from hexdbb.model import Model, load_model, new_model, save_model
from hexdbb.samples import Samples
from hexdbb.samples.places import with_set_up_of

DETERMINED = 1e-4
"""Relative pivot below which `--minimal` holds a value: a record's path leaves its circles by the servos' lag, and what
only that determines is not worth a value."""


@click.command()
@records_argument
@model_option("Model file; made from the record's machine and the thesis' geometric errors where there is none yet.")
@effects_option
@click.option("--free", "free", help="Effects to fit, as leg_length,slider_offset:2; the machine's others are held.")
@click.option("--fix", "fix", help="Effects or elements to hold, as guideway_translation:3,bar_length.")
@click.option(
    "--minimal", is_flag=True, help="Fit as many errors as the readings determine (pivoted QR), hold the rest."
)
@click.option("--robust", is_flag=True, help="Let readings far off (a gauge glitch) count less.")
@plot_option
@json_option
def command(
    records: tuple[Path, ...],
    model_path: Path,
    effects_path: Path | None,
    free: str | None,
    fix: str | None,
    minimal: bool,
    robust: bool,
    folder: Path | None,
    as_json: bool,
) -> None:
    """Fit the free effects of a model to RECORD... (.parquet, .csv, .xlsx, .b5r), write its values.

    \b
    Examples:
      hexdbb diagnose demo.parquet -m demo-model.toml
      hexdbb diagnose monday.parquet tuesday.csv -m model.toml --json
      hexdbb diagnose monday.parquet -m model.toml --minimal
      hexdbb diagnose monday.parquet -m model.toml --plot pictures
      hexdbb diagnose monday.parquet -m model.toml --effects mine.py
      hexdbb diagnose monday.parquet -m model.toml --free leg_length,slider_offset --fix leg_length:6 --robust
    """
    refuse_existing(model_path, overwrite=True)
    if folder is not None:
        require_folder(folder)
    messages = message_console()
    with messages.status("reading records"):
        samples = read_samples(records, messages)
    own = own_effects(effects_path)
    model = load_model(model_path, own) if model_path.exists() else _new_model(samples, model_path, messages)
    model = with_set_up_of(samples, model)
    usual = model.free
    model = choose_free(model, free, fix)
    if minimal:
        model = hold_redundant(samples, model)
    with messages.status(f"fitting {int(model.free.sum())} values to {len(samples):,} readings"):
        found = fit_model(samples, model, robust=robust)
        _ = found.place  # computed here: it takes a moment
    save_model(found.model.with_free(usual), model_path)
    if as_json:
        say(json.dumps(found.to_json(), indent=2, allow_nan=False))
    else:
        output_console().print(diagnosis_text(found), soft_wrap=True)
    messages.print(f"{model_path}: values written")
    if folder is not None:
        _draw(found, folder, messages)


def _draw(found: Diagnosis, folder: Path, messages: Console) -> None:
    from hexdbb.plots import diagnosis_pages, save_pages  # matplotlib takes a second to import

    with messages.status("drawing"):
        written = save_pages(diagnosis_pages(found), folder)
    print_pictures(written, messages)


def choose_free(model: Model, free: str | None, fix: str | None) -> Model:
    """Return the model with the values free that --free and --fix leave so.

    --free holds the machine's other effects; unknowns of the set-up stay as they are in the model unless named.

    Raises
    ------
    InputError
        Where the two contradict one another, or name what is not in the model.
    """
    chosen = model.free
    if free is not None:
        named = model.chosen(free, "--free")
        chosen = named | (chosen & np.array([each.is_set_up for each in model.parameters()]))
    if fix is not None:
        held = model.chosen(fix, "--fix")
        if free is not None and not (model.chosen(free, "--free") & ~held).any():
            raise InputError(f'--free "{free}" and --fix "{fix}" leave nothing to fit (expected one value at least)')
        chosen = chosen & ~held
    return model.with_free(chosen)


def hold_redundant(samples: Samples, model: Model) -> Model:
    """Hold redundant values at zero, so that the fitted ones are identifiable on their own."""
    known = with_set_up_of(samples, model)
    _, held = minimal_set(measured_sensitivity(samples, known), DETERMINED)
    names = {each.label for each in held}
    redundant = np.array([each.label in names for each in known.parameters()])
    values = np.where(redundant, 0.0, known.values)
    sigma = np.where(redundant, np.nan, known.sigma)
    return known.with_values(values, sigma, known.identifiable & ~redundant).with_free(known.free & ~redundant)


def _new_model(samples: Samples, path: Path, messages: Console) -> Model:
    messages.print(f"{path}: new model of {samples.machine.name} with the thesis' geometric errors")
    return new_model(samples.machine)
