"""`hexdbb machine`: a machine file for a machine of one's own, and what such a machine reaches."""

from __future__ import annotations

import click

from hexdbb.cli.machine_check import check
from hexdbb.cli.machine_new import new


@click.group("machine")
def command() -> None:
    """Describe a machine, draw it, and check what it reaches.

    \b
    Examples:
      hexdbb machine new -o machine.toml
      hexdbb machine check machine.toml
    """


for each in (new, check):
    command.add_command(each)
