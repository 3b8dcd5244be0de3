"""`hexdbb plan`: look at a plan before driving it."""

from __future__ import annotations

import json

import click
import numpy as np
from rich.box import SIMPLE_HEAD
from rich.table import Table as Sheet

from hexdbb.capture.bus_load import check_load
from hexdbb.cli.consoles import output_console
from hexdbb.errors import InputError
from hexdbb.machine import MachineFile
from hexdbb.plan import load_plan
from hexdbb.trajectory import Programme, plan_programme

LIMITED = (("velocity", "mm_s"), ("acceleration", "mm_s2"), ("jerk", "mm_s3"))
"""Rates of the sliders that have a limit, in order of differentiation, with the unit of their keys."""
HEADINGS = ("circle", "mm/min", "sense", "samples", "travel", "gap", "speed%", "accel.%", "jerk%")


@click.group("plan")
def command() -> None:
    """Check a plan before driving it.

    \b
    Examples:
      hexdbb plan check thesis
      hexdbb plan check my-plan.toml --json
    """


@command.command("check", short_help="reach and limits of a plan")
@click.argument("plan_name", metavar="PLAN")
@click.option(
    "--rate", "rate_hz", type=click.FloatRange(min=1.0), help="Cycles per second; default: the machine file's."
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def check(plan_name: str, rate_hz: float | None, as_json: bool) -> None:
    """Say whether a plan is within reach and limits, and how much of each limit it uses.

    PLAN is a plan file or the name of a shipped plan. A plan out of reach ends with exit status 2 and names circle,
    angle and limit.

    \b
    Examples:
      hexdbb plan check standard
      hexdbb plan check my-plan.toml --rate 400
    """
    plan = load_plan(plan_name)
    machine = plan.machine_file()
    rate_hz = rate_hz or machine.can_setup.cycle_rate_hz
    try:
        load = check_load(rate_hz, machine.can_setup.bitrate_bit_s, len(machine.can_setup.drive_nodes))
        programme = plan_programme(plan, machine, 1.0 / rate_hz, plan_name)
    except InputError as error:
        if as_json:
            click.echo(json.dumps({"reachable": False, "reason": str(error)}, indent=2))
        raise
    runs = [{**_name(programme, index), **_uses(programme, index, machine)} for index in range(len(programme.runs))]
    if as_json:
        summary = {"reachable": True, "duration_s": programme.duration_s, "bus_load": load, "runs": runs}
        click.echo(json.dumps(summary, indent=2))
        return
    _print(plan_name, programme, load, runs, machine)


def _name(programme: Programme, index: int) -> dict[str, float]:
    run = programme.runs[index]
    return {
        "circle": run.circle.id,
        "feed_mm_min": run.feed_mm_min,
        "direction": run.direction,
        "samples": int((programme.table.capture & (programme.table.run == index)).sum()),
    }


def _uses(programme: Programme, index: int, machine: MachineFile) -> dict[str, float]:
    """Give the largest slider rates of a run, and the least distance to the ends of travel and between two sliders."""
    sliders_mm = programme.table.sliders_mm[programme.table.run == index]
    low_mm, high_mm = machine.sliders.travel_mm
    gaps_mm = sliders_mm[:, 1::2] - sliders_mm[:, 0::2] - machine.sliders.min_gap_mm
    uses = {
        "to_end_of_travel_mm": float(min(sliders_mm.min() - low_mm, high_mm - sliders_mm.max())),
        "to_min_gap_mm": float(gaps_mm.min()),
    }
    rate = sliders_mm
    for name, unit in LIMITED:
        rate = np.diff(rate, axis=0) / programme.cycle_s
        uses[f"{name}_{unit}"] = float(np.abs(rate).max())
    return uses


def _print(
    plan_name: str, programme: Programme, load: float, runs: list[dict[str, float]], machine: MachineFile
) -> None:
    """Print the table for people."""
    limits = machine.can_setup.limits
    sheet = Sheet(
        title=f"plan {plan_name}: within reach and limits", title_justify="left", box=SIMPLE_HEAD, pad_edge=False
    )
    for heading in HEADINGS:
        sheet.add_column(heading, justify="right", no_wrap=True)
    for run in runs:
        shares = [100.0 * run[f"{name}_{unit}"] / getattr(limits, f"{name}_{unit}") for name, unit in LIMITED]
        sheet.add_row(
            f"{run['circle']:g}",
            f"{run['feed_mm_min']:g}",
            f"{run['direction']:+g}",
            f"{run['samples']:g}",
            f"{run['to_end_of_travel_mm']:.1f}",
            f"{run['to_min_gap_mm']:.1f}",
            *(f"{share:.1f}" for share in shares),
        )
    output_console().print(sheet)
    of = ", ".join(f"{getattr(limits, f'{name}_{unit}'):g} {unit.replace('_', '/')}" for name, unit in LIMITED)
    click.echo(f"travel: mm left to its ends; gap: mm left between two sliders; % of the sliders' limits, {of}")
    click.echo(f"{programme.duration_s:.0f} s at {1.0 / programme.cycle_s:g} Hz, bus load {load:.0%} at worst")
