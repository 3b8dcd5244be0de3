"""`hexdbb thesis`: the thesis' method, for comparison: reference contours, its estimator, its tables."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click
from rich.box import SIMPLE_HEAD
from rich.table import Table

from hexdbb.cli.consoles import message_console, output_console, say
from hexdbb.cli.shared_options import stem_of
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing, write_text
from hexdbb.importing import read_measured
from hexdbb.plan import load_plan
from hexdbb.studies.thesis.circular_test import CircularTest, joint_plane_test, plan_test
from hexdbb.studies.thesis.contours import reference_contours
from hexdbb.studies.thesis.estimator import ThesisEstimate, thesis_estimate_record
from hexdbb.studies.thesis.unknowns import UNKNOWNS
from hexdbb.units import readable_unit, shown_factor, shown_unit

ERROR_NAMES = ", ".join(UNKNOWNS)


@click.group("thesis")
def command() -> None:
    """Compute what the thesis computes: reference contours, linear least squares on them, Tables 5.1-5.8.

    A documented mode for comparison with the thesis; to fit a machine, use `hexdbb diagnose`.

    \b
    Examples:
      hexdbb thesis contours -o contours
      hexdbb thesis estimate demo.parquet --errors leg1,leg3,leg5,y1,y2,xy1,xy2
      hexdbb thesis tables
    """


@command.command("contours")
@click.option("-o", "--output", "stem", required=True, metavar="STEM", type=click.Path(path_type=Path))
@click.option("--plan", "plan_name", metavar="PLAN", help="Plan file or shipped plan with the circle.")
@click.option("--circle", "identity", type=int, help="Id of the circle in the plan; default: its first.")
@click.option("--errors", help=f"Comma-separated errors; default: the thesis' 33. Known: {ERROR_NAMES}.")
@click.option("--no-plot", is_flag=True, help="Write no pictures.")
@click.option("--overwrite", is_flag=True, help="Replace existing files.")
def contours(
    stem: Path, plan_name: str | None, identity: int | None, errors: str | None, no_plot: bool, overwrite: bool
) -> None:
    """Write the radial deviation of each unit error along the circle as STEM.csv, STEM.png and STEM.svg.

    Without --plan: a level circle with the ball in the plane of the ball joints (thesis Figures 3.16-3.20).

    \b
    Examples:
      hexdbb thesis contours -o contours
      hexdbb thesis contours --plan standard --circle 1 -o tilted --errors leg1,y1,xy1
    """
    stem = stem_of(stem, Path("contours"))
    table = stem.with_name(f"{stem.name}.csv")
    suffixes = (".csv",) if no_plot else (".csv", ".png", ".svg")
    for suffix in suffixes:
        refuse_existing(stem.with_name(f"{stem.name}{suffix}"), overwrite)
    test = _test(plan_name, identity)
    with message_console().status("computing contours"):
        found = reference_contours(test, _names(errors)) if errors is not None else reference_contours(test)
    write_text(table, found.to_csv())
    written = [table]
    if not no_plot:
        from hexdbb.plots import save_figure  # matplotlib takes a second to import
        from hexdbb.studies.thesis.pictures import contours_figure

        with message_console().status("drawing"):
            written += save_figure(contours_figure(found), stem)
    say(f"{len(found.unknowns)} contours: {', '.join(str(path) for path in written)}", err=True)


@command.command("estimate")
@click.argument("record_path", metavar="RECORD", type=click.Path(path_type=Path))
@click.option("--errors", required=True, help=f"Comma-separated errors assumed to exist. Known: {ERROR_NAMES}.")
@click.option("--minimum-norm", is_flag=True, help="Where A'A is singular, use the solution of smallest norm.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object instead of the table.")
def estimate(record_path: Path, errors: str, minimum_norm: bool, as_json: bool) -> None:
    """Estimate errors by linear least squares on reference contours, equations (5.4)-(5.10).

    The estimate has no uncertainties; it assumes that only the named errors exist and that the cup is where planned.

    \b
    RECORD is a Parquet record, or a file of another program with its mapping beside it. Examples:
      hexdbb thesis estimate demo.parquet --errors leg1,leg3,leg5,y1,y2
      hexdbb thesis estimate demo.csv --errors leg1,y1,cup_x,cup_y --json
    """
    with message_console().status("estimating"):
        found = thesis_estimate_record(read_measured(record_path), _names(errors), minimum_norm=minimum_norm)
    if as_json:
        say(json.dumps(_to_json(found), indent=2, allow_nan=False))
        return
    sheet = Table(box=SIMPLE_HEAD, pad_edge=False)
    for heading in ("error", "value", "unit", "determined"):
        sheet.add_column(heading, justify="right" if heading == "value" else "left")
    for row in _to_json(found)["parameters"]:
        sheet.add_row(
            row["error"], f"{row['value']:.2f}", readable_unit(row["unit"]), "yes" if row["determined"] else "no"
        )
    output_console().print(sheet)
    for sentence in found.dependent:
        say(f"dependent contours, in unit errors: {sentence}")
    say(f"contour {1e3 * found.rms_before_mm:.2f} µm RMS, residual {1e3 * found.rms_after_mm:.2f} µm RMS")
    say("valid only if no other error exists and the cup is where planned; hexdbb diagnose assumes neither")


@command.command("tables")
def tables() -> None:
    """Print Tables 5.1-5.8, given against identified values, and the reason for their results, as Markdown.

    \b
    Example:
      hexdbb thesis tables > thesis-tables.md
    """
    from hexdbb.studies.thesis.tables_page import tables_page

    with message_console().status("computing Tables 5.1-5.8"):
        page = tables_page()
    say(page, nl=False)


@command.command("pages")
@click.option(
    "-o",
    "--output",
    "directory",
    required=True,
    metavar="DIRECTORY",
    type=click.Path(path_type=Path, exists=True, file_okay=False),
)
def pages(directory: Path) -> None:
    """Write the pages of contours and tables with their pictures, replacing existing ones.

    \b
    Example:
      hexdbb thesis pages -o docs
    """
    from hexdbb.studies.thesis.pages import write_pages

    with message_console().status("computing and drawing"):
        written = write_pages(directory)
    say(f"written: {', '.join(map(str, written))}", err=True)


def _test(plan_name: str | None, identity: int | None) -> CircularTest:
    if plan_name is None:
        if identity is not None:
            raise InputError(f"--circle {identity} without --plan: expected the plan to which it belongs")
        return joint_plane_test()
    plan = load_plan(plan_name)
    which = plan.circles[0].id if identity is None else identity
    return plan_test(plan, which, f"plan {plan_name}, circle {which}")


def _names(errors: str) -> list[str]:
    return [name.strip() for name in errors.split(",")]


def _to_json(found: ThesisEstimate) -> dict[str, Any]:
    parameters = [
        {
            "error": each.name,
            "effect": each.parameter.effect,
            "element": each.parameter.element,
            "name": each.parameter.name,
            "value": float(value) * shown_factor(each.unit),
            "unit": shown_unit(each.unit),
            "determined": bool(determined),
        }
        for each, value, determined in zip(found.unknowns, found.values, found.determined, strict=True)
    ]
    return {
        "parameters": parameters,
        "rank": found.rank,
        "condition": found.condition,
        "dependent": list(found.dependent),
        "rms_before_um": 1e3 * found.rms_before_mm,
        "rms_after_um": 1e3 * found.rms_after_mm,
    }
