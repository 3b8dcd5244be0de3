"""`hexdbb plan compare`: what several plans can tell, side by side."""

from __future__ import annotations

import json

import click

from hexdbb.cli.plan_judgement import judge, noise_option
from hexdbb.cli.plan_sheets import print_comparison
from hexdbb.model import new_model
from hexdbb.plan import load_plan


@click.command("compare", short_help="rank, condition and indices of plans side by side")
@click.argument("plan_names", metavar="PLAN...", nargs=-1, required=True)
@noise_option
@click.option("--json", "as_json", is_flag=True, help="Print JSON, one object a plan.")
def compare(plan_names: tuple[str, ...], noise_um: float | None, as_json: bool) -> None:
    """Hold plans beside each other: rank, condition and observability indices of the thesis' 33 errors.

    PLAN is a plan file or the name of a shipped plan.

    \b
    Examples:
      hexdbb plan compare standard best5 best7
      hexdbb plan compare thesis my-plan.toml --json
    """
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
