"""Options of `hexdbb-run` on what a report should say of the test: operator, notes, serial numbers, calibration."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import datetime
from typing import Any

import click

from hexdbb.capture.request import Request
from hexdbb.errors import InputError
from hexdbb.plan import Conditions

Command = Callable[..., Any]


def conditions_options(command: Command) -> Command:
    """Add the options to a command."""
    options = (
        click.option("--operator", metavar="NAME", help="Who tests; kept in the record, as are the next four."),
        click.option("--note", "notes", metavar="TEXT", multiple=True, help="What should be remembered; repeatable."),
        click.option("--machine-serial", metavar="NUMBER", help="Serial number of the machine."),
        click.option("--gauge-serial", metavar="NUMBER", help="Serial number of the ball bar."),
        click.option(
            "--gauge-calibrated",
            metavar="YYYY-MM-DD",
            type=click.DateTime(["%Y-%m-%d"]),
            help="Date of the ball bar's calibration.",
        ),
    )
    for option in reversed(options):
        command = option(command)
    return command


def conditions_asked(operator: str | None, notes: Sequence[str], temperature_c: float | None) -> Conditions:
    """Return the conditions that the options state."""
    if temperature_c is not None and not math.isfinite(temperature_c):
        raise InputError(f"--temperature-c {temperature_c}: expected a temperature in °C")
    return Conditions(operator=operator or None, notes="\n".join(notes) or None, temperature_c=temperature_c)


def numbered(
    request: Request, machine_serial: str | None, gauge_serial: str | None, calibrated: datetime | None
) -> Request:
    """Return a request whose machine and gauge have the serial numbers and the calibration date that are given."""
    gauge_says: dict[str, object] = {
        **({"serial_number": gauge_serial} if gauge_serial else {}),
        **({"calibrated": calibrated.date()} if calibrated is not None else {}),
    }
    machine_says = {"serial_number": machine_serial} if machine_serial else {}
    gauge = request.plan.gauge.model_copy(update=gauge_says)
    return replace(
        request,
        plan=request.plan.model_copy(update={"gauge": gauge}),
        machine=request.machine.model_copy(update=machine_says),
    )
