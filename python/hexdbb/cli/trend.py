"""`hexdbb trend`: what changes over the records of a logbook, and what is beyond its limit."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import click

from hexdbb.cli.consoles import end_output, message_console, output_console, say
from hexdbb.cli.effects_option import effects_option, own_effects
from hexdbb.cli.existing_model import existing_model
from hexdbb.cli.shared_options import json_option, model_option, print_pictures, stem_of
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing
from hexdbb.logbook import Logbook
from hexdbb.model import Model, load_model
from hexdbb.trend import Trend, parsed_time, trend
from hexdbb.trend.text import trend_text


@click.command("trend")
@click.argument("folder", metavar="FOLDER", type=click.Path(path_type=Path))
@model_option(
    "Model whose free effects are fitted; default: the newest of the logbook, else the thesis' geometric errors.", False
)
@effects_option
@click.option("--since", help="Leave out records measured before this date.")
@click.option(
    "--plot",
    "prefix",
    metavar="PREFIX",
    type=click.Path(path_type=Path),
    help="Write PREFIX.png and PREFIX-effects.png; without it trend.png and trend-effects.png in FOLDER.",
)
@click.option("--no-plot", is_flag=True, help="Write no pictures.")
@json_option
def command(
    folder: Path,
    model_path: Path | None,
    effects_path: Path | None,
    since: str | None,
    prefix: Path | None,
    no_plot: bool,
    as_json: bool,
) -> None:
    """Show what changes over the records of the logbook in FOLDER, and what is beyond a limit of its machine file.

    All records are fitted together: the machine's errors are shared, cup and ball are each record's own. Then each
    element of each effect is tried as one that changes from record to record, and what the readings ask for is
    named. Effects that the machine file watches join the model by themselves. Change points part straight lines of
    time; intervals are two standard deviations.

    \b
    Exit status: 0 nothing is beyond a limit, 3 something is, 4 something is beyond its alarm;
    1 the fit did not succeed, 2 wrong use.

    \b
    Examples:
      hexdbb trend glider
      hexdbb trend glider -m model.toml --since 2025-06-01 --plot autumn
      hexdbb trend glider --json --no-plot > trend.json || mail -s "glider: $?" workshop < trend.json
    """
    if prefix is not None and no_plot:
        raise InputError(f"--plot {prefix} together with --no-plot: expected one of them")
    logbook = Logbook(folder)
    stem = stem_of(prefix, folder / "trend")
    for suffix in () if no_plot else (".png", "-effects.png"):
        refuse_existing(stem.with_name(stem.name + suffix), overwrite=True)
    first = None if since is None else parsed_time(since, "--since")
    messages = message_console()
    with messages.status("reading records") as status:
        records = [each for each in logbook.records() if first is None or each.measured >= first]
        if not records:
            when = f" since {since}" if since else ""
            raise InputError(f"{folder}: no complete record{when} (expected one at least: hexdbb log add)")
        model = _model(logbook, model_path, effects_path)
        found = trend(records, logbook.machine, model, lambda doing: status.update(doing))
    if as_json:
        say(json.dumps(found.to_json().to_json(), indent=2, allow_nan=False))
    else:
        output_console().print(trend_text(found), soft_wrap=True)
    if not no_plot:
        print_pictures(_draw(found, stem), messages)
    end_output()
    sys.exit(found.status)


def _model(logbook: Logbook, path: Path | None, effects_path: Path | None) -> Model | None:
    if path is not None:
        model = existing_model(path, effects_path)
        logbook.require(model.machine, str(path))
        return model
    models = logbook.entries("model")
    return load_model(logbook.path_of(models[-1]), own_effects(effects_path)) if models else None


def _draw(found: Trend, stem: Path) -> list[Path]:
    from hexdbb.plots import save_figure, trend_effects_figure, trend_figure  # matplotlib takes a second to import

    written = save_figure(trend_figure(found), stem, [".png"])
    return written + save_figure(trend_effects_figure(found), stem.with_name(f"{stem.name}-effects"), [".png"])
