"""`hexdbb plan compare`: what several plans would determine, side by side."""

from __future__ import annotations

import json
from pathlib import Path

import click

from hexdbb.cli.consoles import say
from hexdbb.cli.plan_assessment import assess_plan, noise_option
from hexdbb.cli.plan_tables import print_comparison
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing
from hexdbb.model import new_model
from hexdbb.plan import load_plan
from hexdbb.planning import spectrum_figure
from hexdbb.plots.saving import FORMATS, save_figure


@click.command("compare", short_help="rank, condition and indices of plans side by side")
@click.argument("plan_names", metavar="PLAN...", nargs=-1, required=True)
@noise_option
@click.option(
    "--plot",
    type=click.Path(path_type=Path),
    help="Picture of the singular values to write (.png or .svg); an existing file is replaced.",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON, one object per plan.")
def compare(plan_names: tuple[str, ...], noise_um: float | None, plot: Path | None, as_json: bool) -> None:
    """Compare plans: rank, condition and observability indices of the thesis' 33 errors.

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
        assessment = assess_plan(plan, new_model(machine), machine.can_setup.cycle_rate_hz, noise_um, name)
        plans[name] = (plan, assessment)
    if as_json:
        say(json.dumps({name: assessment.to_json() for name, (_, assessment) in plans.items()}, indent=2))
    else:
        print_comparison(plans)
    if plot is not None:
        spectra = {Path(name).stem: assessment.observability for name, (_, assessment) in plans.items()}
        (drawn,) = save_figure(spectrum_figure(spectra), plot.with_suffix(""), [plot.suffix])
        say(f"{drawn}: picture written", err=True)


def _check_picture(path: Path) -> None:
    if path.suffix not in FORMATS:
        raise InputError(f"{path}: not a format of pictures (expected {' or '.join(FORMATS)})")
    refuse_existing(path, overwrite=True)
