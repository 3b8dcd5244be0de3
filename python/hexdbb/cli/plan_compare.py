"""`hexdbb plan compare`: what several plans can tell, side by side."""

from __future__ import annotations

import json
from pathlib import Path

import click

from hexdbb.cli.plan_judgement import judge, noise_option
from hexdbb.cli.plan_sheets import print_comparison
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing
from hexdbb.model import new_model
from hexdbb.plan import load_plan
from hexdbb.planning import spectrum_figure
from hexdbb.plots.pages import FORMATS, save_figure


@click.command("compare", short_help="rank, condition and indices of plans side by side")
@click.argument("plan_names", metavar="PLAN...", nargs=-1, required=True)
@noise_option
@click.option(
    "--plot",
    type=click.Path(path_type=Path),
    help="Picture of the singular values to draw (.png or .svg), replaced where there is one.",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON, one object a plan.")
def compare(plan_names: tuple[str, ...], noise_um: float | None, plot: Path | None, as_json: bool) -> None:
    """Hold plans beside each other: rank, condition and observability indices of the thesis' 33 errors.

    PLAN is a plan file or the name of a shipped plan.

    \b
    Examples:
      hexdbb plan compare standard my-plan.toml
      hexdbb plan compare thesis standard --plot plans.png
      hexdbb plan compare thesis my-plan.toml --json
    """
    if plot is not None:
        _check_picture(plot)
    plans = {}
    for name in plan_names:
        plan = load_plan(name)
        machine = plan.machine_file()
        found = judge(plan, new_model(machine), machine.can_setup.cycle_rate_hz, noise_um, name)
        plans[name] = (plan, found)
    if as_json:
        click.echo(json.dumps({name: found.to_json() for name, (_, found) in plans.items()}, indent=2))
    else:
        print_comparison(plans)
    if plot is not None:
        seen = {Path(name).stem: found.observability for name, (_, found) in plans.items()}
        (drawn,) = save_figure(spectrum_figure(seen), plot.with_suffix(""), [plot.suffix])
        click.echo(f"{drawn}: drawn", err=True)


def _check_picture(path: Path) -> None:
    if path.suffix not in FORMATS:
        raise InputError(f"{path}: not a picture that can be drawn (expected {' or '.join(FORMATS)})")
    refuse_existing(path, overwrite=True)
