"""A discovery for people: the answer in a sentence, what it rests on, what remains, what to do next."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table

from hexdbb.discovery import Candidate, Cause, Discovery
from hexdbb.discovery.words import GROUPS
from hexdbb.units import readable_unit


def print_discovery(found: Discovery, console: Console, records: str, model_path: Path) -> None:
    """Print a discovery."""

    def line(text: str, style: str = "") -> None:
        console.print(text, style=style, highlight=False, soft_wrap=True)

    lack = found.lack_of_fit
    line(found.sentence, "bold")
    line(f"residual {lack.rms_um:.2f} µm RMS, noise {lack.noise_um:.2f} µm; {found.sufficiency.sentence}")
    for cause in found.causes:
        _print_doubts(cause, line)
    if found.candidates:
        line("Hypotheses; after their RMS the error where circles, feeds, directions or laps were left out, µm:")
        console.print(_candidates(found.candidates))
    known = [each for each in found.causes if each.values]
    if known:
        console.print(_values(known))
    if found.remaining is not None:
        added = " + ".join(each.choice for each in known)
        line(f"with {added}: {found.rms_before_um:.2f} µm -> {found.rms_after_um:.2f} µm; {found.remaining.sentence}")
    for remark in found.remarks:
        line(remark)
    if found.structure:
        line("Predictors of the remaining residual (explained variance, cross-validated):")
        for each in found.structure:
            line(f"  {each.share:6.1%}  {each.sentence}")
    for text in _next(found, records, model_path):
        line(text)


def _print_doubts(cause: Cause, line: Callable[[str], None]) -> None:
    if cause.alike:
        line(f"{cause.choice}: {', '.join(cause.alike)} would explain these readings as well")
    if cause.refinements:
        line(f"{cause.choice}: its form is described by {', '.join(cause.refinements)}")


def _candidates(candidates: tuple[Candidate, ...]) -> Table:
    """Return the table of hypotheses: evidence, part explained, error by what was left out, why refused."""
    groups = [name for name in GROUPS if any(name in each.heldout for each in candidates)]
    table = Table(box=None, header_style="bold", pad_edge=False)
    table.add_column("hypothesis", no_wrap=True, min_width=max(len(each.choice) for each in candidates))
    for name in ("log evidence", "explains", "RMS, µm", *(GROUPS[name] for name in groups)):
        table.add_column(name, justify="right", min_width=max(map(len, name.split())))
    table.add_column("refused", min_width=len("refused"))
    for each in candidates:
        errors = [f"{each.heldout[name].after_um:.2f}" if name in each.heldout else "" for name in groups]
        numbers = (f"{each.log_evidence:,.0f}", f"{each.share:.0%}", f"{each.rms_after_um:.2f}")
        table.add_row(each.choice, *numbers, *errors, "; ".join(each.refused))
    return table


def _values(causes: Sequence[Cause]) -> Table:
    table = Table(box=None, header_style="bold", pad_edge=False)
    for name in ("effect", "element", "parameter", "value", "± 1 sigma", "unit"):
        table.add_column(name, justify="right" if name in ("value", "± 1 sigma") else "left")
    for cause in causes:
        for index, each in enumerate(cause.values):
            sigma = "-" if each.sigma is None else f"{each.sigma:.3g}"
            name = "" if index else cause.effect
            table.add_row(name, each.element, each.name, f"{each.value:.4g}", sigma, readable_unit(each.unit))
    return table


def _next(found: Discovery, records: str, model_path: Path) -> list[str]:
    if found.next_test is not None:
        circle = found.next_test.circle
        return [
            f"next best test: a circle of radius {circle.radius_mm:.4g} mm, platform"
            f" {list(circle.platform_rpy_deg)} deg, plane {list(circle.plane_rpy_deg)} deg (roll, pitch, yaw), at"
            f" {found.next_test.feed_mm_min:g} mm/min: it would show {found.next_test.expected_sigmas:.0f} standard"
            " deviations between them"
        ]
    if found.verdict == "effect" and found.best is not None:
        return [f"next: hexdbb add {found.best.choice} -m {model_path} {records}"]
    if found.verdict == "unknown" and found.causes and found.causes[0].function is not None:
        return [
            "next: give it its physics, as an effect of your own that is drafted by:"
            f" hexdbb discover {records} -m {model_path} --draft mine.py"
        ]
    if found.verdict == "unknown":
        return [
            "next: write what it may be as an effect of your own, and let it compete:"
            f" hexdbb discover {records} -m {model_path} --effects mine.py"
        ]
    return []
