"""The command `hexdbb`: one module per subcommand, imported when it is called, so that `--help` stays fast."""

from __future__ import annotations

import importlib

import click

from hexdbb import __version__
from hexdbb.cli.exits import reports_errors

COMMANDS = {
    "rig": "the simulated rig as a process of its own",
    "model": "make model files",
    "diagnose": "fit the model's effects to records",
    "effects": "effects a model can have; the handbook of them",
    "discover": "which effect is missing from a model",
    "compare": "prediction against measurement, ISO 230-4 quantities, where the model fails",
    "add": "one effect more in a model, and how the error falls",
    "undo": "take back what was last done to a model",
    "history": "what was done to a model, step by step",
    "compensate": "compensation data for motion controllers, or a path corrected",
    "plan": "check a plan: reach, limits",
    "thesis": "the thesis' own way: reference contours, its linear estimator, its tables",
    "convert": "between record (.parquet) and text form (.csv)",
    "recover": "make a record from an interrupted capture",
}


class _LazyGroup(click.Group):
    """A click group whose commands live in `hexdbb.cli.<name>` as the object `command`."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = importlib.import_module(f"hexdbb.cli.{cmd_name}").command
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))


@click.group(cls=_LazyGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="hexdbb")
def cli() -> None:
    """Find out why a HexGlider does not go where it is told, from double-ball-bar circular tests.

    \b
    Measure with hexdbb-run, then for example:
      hexdbb diagnose demo.parquet -m model.toml
      hexdbb compare  demo.parquet -m model.toml
    """


def main() -> None:
    """Run the command line; errors of hexdbb become one line on stderr and an exit status."""
    reports_errors(cli)
