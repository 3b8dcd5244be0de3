"""`hexdbb workbench`: a local page in which records and a model are seen, tried and extended."""

from __future__ import annotations

import webbrowser
from pathlib import Path

import click

from hexdbb.cli.consoles import say
from hexdbb.cli.effects_option import effects_option
from hexdbb.cli.import_options import wanted_mapping
from hexdbb.cli.shared_options import model_option, records_argument
from hexdbb.errors import InputError
from hexdbb.pages import MISSING
from hexdbb.workbench import Session
from hexdbb.workbench.own_code import COMPUTING_S


@click.command("workbench")
@records_argument
@model_option(
    "Model file; made by the first step where it is not there. Without it the model is in memory until saved.", False
)
@effects_option
@click.option("--port", type=click.IntRange(0, 65535), default=0, help="Port on 127.0.0.1; a free one where 0.")
@click.option("--no-browser", is_flag=True, help="Print the address only, open no browser.")
@click.option("--allow-code", is_flag=True, help="Let the page write and run effects of your own: it runs Python.")
@click.option(
    "--code-seconds",
    type=click.IntRange(min=1),
    default=COMPUTING_S,
    show_default=True,
    help="Seconds of computing after which an effect of your own that does not end is stopped when it is tried.",
)
def command(
    records: tuple[Path, ...],
    model_path: Path | None,
    effects_path: Path | None,
    port: int,
    no_browser: bool,
    allow_code: bool,
    code_seconds: int,
) -> None:
    """Open RECORD... (.parquet, .csv, .xlsx, .b5r) and a model in a page of this computer's browser.

    Charts of every circle, measured and predicted; effects to switch off and values to drag; what is missing, previewed
    before it is added; undo and history; next circle, compensation and report. Every step is also a line of Python.

    The page is served on 127.0.0.1 only, to whoever has the address printed; Ctrl-C ends it.

    \b
    Examples:
      hexdbb workbench today.parquet -m model.toml
      hexdbb workbench monday.parquet tuesday.csv -m model.toml --no-browser --port 8080
      hexdbb workbench today.parquet -m model.toml --allow-code
    """
    try:
        from hexdbb.workbench.server import serve  # the page's framework takes a second to import
    except ModuleNotFoundError as error:
        if error.name is None or error.name.startswith("hexdbb"):
            raise
        raise InputError(f"hexdbb workbench: {MISSING}") from None
    session = Session(
        records, model_path, effects_path, mapping=wanted_mapping(), tell=lambda line: say(line, err=True)
    )

    def ready(address: str) -> None:
        say(address)
        if not no_browser:
            webbrowser.open(address)

    try:
        serve(session, port, allow_code=allow_code, code_seconds=code_seconds, ready=ready)
    except KeyboardInterrupt:
        return
