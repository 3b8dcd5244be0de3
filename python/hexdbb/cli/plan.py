"""`hexdbb plan`: check, compare and propose plans before they are driven."""

from __future__ import annotations

import click

from hexdbb.cli.plan_check import check
from hexdbb.cli.plan_compare import compare
from hexdbb.cli.plan_propose import propose_command


@click.group("plan")
def command() -> None:
    """Check, compare and propose plans before they are driven.

    \b
    Examples:
      hexdbb plan check thesis
      hexdbb plan compare standard my-plan.toml
      hexdbb plan propose --circles 5 -o my-plan.toml
    """


for each in (check, compare, propose_command):
    command.add_command(each)
