"""`hexdbb discover`: whether anything is missing from a model, and which effect it is."""

from __future__ import annotations

import json
from pathlib import Path

import click
from rich.console import Console
from rich.table import Table

from hexdbb.cli.add import print_added
from hexdbb.cli.consoles import output_console
from hexdbb.cli.effects_option import effects_option
from hexdbb.cli.existing_model import existing_model
from hexdbb.cli.shared_options import json_option, model_option, records_argument
from hexdbb.discovery import AutoStep, Candidate, Discovery, discover, discover_all
from hexdbb.discovery.search import Progress
from hexdbb.files.atomic_file import refuse_existing
from hexdbb.model import Model, save_model
from hexdbb.record import read_record
from hexdbb.samples import Samples
from hexdbb.units import readable_unit


@click.command()
@records_argument
@model_option("Model file.")
@effects_option
@click.option("--auto", is_flag=True, help="Add what is missing to the model file, effect after effect.")
@json_option
def command(records: tuple[Path, ...], model_path: Path, effects_path: Path | None, auto: bool, as_json: bool) -> None:
    """Find out which effect a model lacks, from RECORD... (.parquet or .csv).

    The verdict is one of: an effect; one of several that these readings cannot separate, with the circle that
    would; nothing missing; something missing that no known effect explains, with the variables that predict it.

    The model file is not changed, unless by --auto: it adds what is found and looks again, until nothing is missing or
    the cause is not identified. An effect added earlier is taken out again where a later one makes it needless.

    \b
    Examples:
      hexdbb discover today.parquet -m model.toml
      hexdbb discover monday.parquet tuesday.csv -m model.toml --json
      hexdbb discover today.parquet -m model.toml --effects mine.py
      hexdbb discover today.parquet -m model.toml --auto
    """
    if auto:
        refuse_existing(model_path, overwrite=True)
    model = existing_model(model_path, effects_path)
    messages = Console(stderr=True, emoji=False)
    with messages.status("reading records") as status:
        samples = Samples.of([read_record(path) for path in records])
        if auto:
            steps, found = _automatic(samples, model, model_path, None if as_json else output_console(), status.update)
        else:
            steps, found = [], discover(samples, model, progress=status.update)
    if as_json:
        shown = found.to_json([each.diagnosis for each in steps])
        click.echo(json.dumps(shown, indent=2, allow_nan=False))
        return
    print_discovery(found, output_console(), " ".join(map(str, records)), model_path)


def _automatic(
    samples: Samples, model: Model, model_path: Path, console: Console | None, progress: Progress
) -> tuple[list[AutoStep], Discovery]:
    """Add effects, the model file written and the step printed after each; return the steps and the last look."""
    steps: list[AutoStep] = []
    for each in discover_all(samples, model, progress=progress):
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


def print_discovery(found: Discovery, console: Console, records: str, model_path: Path) -> None:
    """Print a discovery for people: the verdict, what it rests on, what to do next."""
    console.print(found.sentence, style="bold", highlight=False, soft_wrap=True)
    lack = found.lack_of_fit
    console.print(
        f"residual {lack.rms_um:.2f} µm RMS, noise {lack.noise_um:.2f} µm;"
        f" unexplained {lack.unexplained_um:.2f} µm; whiteness test {p_words(lack.shape_p)}",
        highlight=False,
        soft_wrap=True,
    )
    if found.best is not None:
        console.print(f"with it: {found.rms_before_um:.2f} µm -> {found.rms_after_um:.2f} µm", highlight=False)
        if found.heldout_before_um is not None and found.heldout_after_um is not None:
            console.print(
                f"held-out circles: {found.heldout_before_um:.2f} µm -> {found.heldout_after_um:.2f} µm RMS",
                highlight=False,
            )
    if found.verdict != "none" and found.candidates:
        console.print(_candidates(found.candidates))
    if found.best is not None:
        console.print(_values(found.best))
    if found.structure:
        console.print("Predictors of the remaining residual (explained variance, cross-validated):")
        for each in found.structure:
            console.print(f"  {each.share:6.1%}  {each.sentence}", highlight=False, soft_wrap=True)
    _print_next(found, console, records, model_path)


def _candidates(candidates: tuple[Candidate, ...]) -> Table:
    table = Table(box=None, header_style="bold", pad_edge=False)
    for name in ("effect", "RMS after, µm", "share", "BIC drop", "p"):
        table.add_column(name, justify="left" if name == "effect" else "right")
    for each in candidates:
        table.add_row(
            each.choice, f"{each.rms_after_um:.2f}", f"{each.share:.0%}", f"{each.bic_drop:,.0f}", p_shown(each.p_value)
        )
    return table


def _values(best: Candidate) -> Table:
    table = Table(box=None, header_style="bold", pad_edge=False)
    for name in (best.effect, "parameter", "value", "± 1 sigma", "unit"):
        table.add_column(name, justify="right" if name in ("value", "± 1 sigma") else "left")
    for each in best.values:
        sigma = "-" if each.sigma is None else f"{each.sigma:.3g}"
        table.add_row(each.element, each.name, f"{each.value:.4g}", sigma, readable_unit(each.unit))
    return table


def _print_next(found: Discovery, console: Console, records: str, model_path: Path) -> None:
    for remark in found.remarks:
        console.print(remark, highlight=False, soft_wrap=True)
    if found.next_test is not None:
        circle = found.next_test.circle
        console.print(
            f"next best test: a circle of radius {circle.radius_mm:.4g} mm, platform"
            f" {list(circle.platform_rpy_deg)} deg, plane {list(circle.plane_rpy_deg)} deg (roll, pitch, yaw), at"
            f" {found.next_test.feed_mm_min:g} mm/min: it would show {found.next_test.expected_sigmas:.0f} standard"
            " deviations between them",
            highlight=False,
            soft_wrap=True,
        )
    if found.verdict == "effect" and found.best is not None:
        console.print(
            f"next: hexdbb add {found.best.choice} -m {model_path} {records}", highlight=False, soft_wrap=True
        )
    if found.verdict == "unknown":
        console.print(
            "next: write what it may be as an effect of your own, and let it compete:"
            f" hexdbb discover {records} -m {model_path} --effects mine.py",
            highlight=False,
            soft_wrap=True,
        )


def p_shown(p_value: float) -> str:
    """Return a p-value for people; below 1e-16 it is a rounding error of 1."""
    return "< 1e-16" if p_value < 1e-16 else f"{p_value:.1g}"


def p_words(p_value: float) -> str:
    """Return ``p = 0.03`` or ``p < 1e-16``."""
    shown = p_shown(p_value)
    return f"p {shown}" if shown.startswith("<") else f"p = {shown}"
