"""`hexdbb diagnose`: fit a model's effects to records and say what is known."""

from __future__ import annotations

import json
from pathlib import Path

import click
from rich.console import Console
from rich.table import Table

from hexdbb.diagnosis import Diagnosis, diagnose
from hexdbb.model import Model, load_model, new_model, save_model
from hexdbb.record import Record, read_record
from hexdbb.units import shown_factor, shown_unit


@click.command()
@click.argument("records", metavar="RECORD...", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option(
    "-m",
    "--model",
    "model_path",
    required=True,
    type=click.Path(path_type=Path),
    help="Model file; made from the record's machine and the thesis' geometric errors where there is none yet.",
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object on stdout.")
def command(records: tuple[Path, ...], model_path: Path, as_json: bool) -> None:
    """Fit the free effects of a model to RECORD... (.parquet or .csv) and write the values into the model file.

    \b
    Examples:
      hexdbb diagnose demo.parquet -m demo-model.toml
      hexdbb diagnose monday.parquet tuesday.csv -m model.toml --json
    """
    messages = Console(stderr=True)
    with messages.status("reading records"):
        read = [read_record(path) for path in records]
    model = load_model(model_path) if model_path.exists() else _model_of(read[0], model_path, messages)
    with messages.status(f"fitting {int(model.free.sum())} values to {sum(map(_rows, read)):,} readings"):
        found = diagnose(read, model)
    save_model(found.model, model_path)
    if as_json:
        click.echo(json.dumps(found.to_json(), indent=2))
    else:
        print_diagnosis(found, Console())
    messages.print(f"{model_path}: values written", highlight=False)


def print_diagnosis(found: Diagnosis, console: Console) -> None:
    """Print a diagnosis for people: the fall of the error, values and uncertainties, what cannot be known."""
    console.print(
        f"reading error {found.rms_before_um:.2f} um -> {found.rms_after_um:.2f} um RMS"
        f" (gauge noise {found.noise_um:.2f} um)",
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
    for name, side in (("effect", "left"), ("element", "left"), ("parameter", "left"), ("value", "right")):
        table.add_column(name, justify=side)  # type: ignore[arg-type]
    table.add_column("± 1 sigma", justify="right")
    table.add_column("unit")
    index = 0
    parameters = model.parameters()
    for term in model.terms:
        if not term.free:
            index += len(term.values)
            continue
        for place, value in enumerate(term.values):
            each = parameters[index]
            factor = shown_factor(each.unit)
            sigma = f"{term.sigma[place] * factor:.2f}" if term.identifiable[place] else "~"
            name = each.effect if place == 0 else ""
            table.add_row(name, each.element, each.name, f"{value * factor:.2f}", sigma, shown_unit(each.unit))
            index += 1
    return table


def _model_of(record: Record, path: Path, messages: Console) -> Model:
    messages.print(f"{path}: new model of {record.machine.name} with the thesis' geometric errors", highlight=False)
    return new_model(record.machine)


def _machine_values(model: Model) -> int:
    return sum(not each.is_set_up for each, free in zip(model.parameters(), model.free, strict=True) if free)


def _rows(record: Record) -> int:
    return len(record.columns["t_s"])
