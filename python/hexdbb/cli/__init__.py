"""The command `hexdbb`: one module per subcommand, imported when called, so that `--help` stays fast."""

from __future__ import annotations

import importlib

import click

from hexdbb.cli.exits import Program, reports_errors
from hexdbb_start import ends_at_once, keeps_all

COMMANDS = {
    "demo": "find a fault hidden in a simulated machine, step by step",
    "rig": "run the simulated rig as a process of its own",
    "eds": "check whether drives and gauges can run the test, by their EDS files",
    "machine": "describe a machine of one's own, draw it, check what it reaches",
    "check-realtime": "measure whether this computer can send a SYNC at every deadline",
    "model": "create model files",
    "diagnose": "fit the model's effects to records",
    "effects": "list the effects a model can have; write their handbook",
    "discover": "find the effect that a model lacks",
    "compare": "compare prediction and measurement: ISO 230-4 quantities, where the model fails",
    "report": "write one page to hand over: verdict, contributions ranked, circles, what to measure next",
    "add": "add an effect to a model and fit it",
    "undo": "undo the last change of a model",
    "history": "list the changes of a model, step by step",
    "compensate": "write compensation data for motion controllers, or a corrected path",
    "plan": "check, propose and compare plans: reach, limits, identifiability",
    "log": "keep the logbook of a machine: records, models, verdicts, compensation files",
    "trend": "what changes over the records of a logbook; limits, change points, pictures",
    "fleet": "judge the records of many machines on many cores; what they say of the fleet",
    "workbench": "see and play with records and a model in a page of the browser",
    "study": "simulate many machines: power, coverage, verdicts, plans, tolerances",
    "thesis": "the method of the thesis: reference contours, linear estimator, tables",
    "convert": "make records of files of other programs; convert records between formats",
    "recover": "write the record of an interrupted capture",
}


class _LazyGroup(Program, click.Group):
    """Click group whose subcommands are the objects `command` of the modules `hexdbb.cli.<name>`."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        with ends_at_once(), keeps_all():
            command: click.Command = importlib.import_module(f"hexdbb.cli.{cmd_name.replace('-', '_')}").command
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))


@click.group(cls=_LazyGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="hexdbb", prog_name="hexdbb")
def cli() -> None:
    """Find out why a HexGlider does not go where it is told, from double-ball-bar circular tests.

    \b
    See what it does: hexdbb demo. Measure with hexdbb-run, then for example:
      hexdbb diagnose demo.parquet -m model.toml
      hexdbb compare  demo.parquet -m model.toml
    """


def main() -> None:
    """Run the command line; report an error of hexdbb as one line on stderr and exit with its status."""
    reports_errors(cli)
