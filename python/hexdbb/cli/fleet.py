"""`hexdbb fleet`: the records of many machines judged on many cores, and what they say of the fleet."""

from __future__ import annotations

import json
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import click

from hexdbb.cli.cluster_options import cluster_options, shown_progress, summary_text
from hexdbb.cli.consoles import message_console, output_console, say
from hexdbb.cli.shared_options import json_option
from hexdbb.cluster import ClusterOptions, connected
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing
from hexdbb.files.validation import read_text

urls_argument = click.argument("urls", metavar="URL...", nargs=-1, required=True)
output_option = click.option(
    "-o", "--output", "output", metavar="URL", required=True, help="Folder of the results; those it has are not redone."
)
model_option = click.option(
    "-m",
    "--model",
    "model_path",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="Model whose free effects are fitted, or machine file; default: each record's machine, geometric errors.",
)
again_option = click.option("--again", is_flag=True, help="Try records again that failed (a store did not answer).")


@click.group("fleet")
def command() -> None:
    """Judge the records of many machines, anywhere that fsspec reaches, on the cores of one computer or of many.

    \b
    Examples:
      hexdbb fleet diagnose records -o results
      hexdbb fleet discover "s3://plant/2026/*.parquet" -o s3://plant/verdicts --scheduler tcp://10.0.0.5:8786
      hexdbb fleet report results -o fleet.html
    """


@command.command("diagnose")
@urls_argument
@output_option
@model_option
@again_option
@cluster_options
def diagnose_command(**options: Any) -> None:
    """Fit a model to each of the records at URL...; one row a record and value.

    URL is a file, a folder or a pattern: local, or s3://bucket/folder with the package s3fs. Results are a Parquet
    dataset partitioned by machine and month, which pandas, DuckDB and Spark read as it is. A record that cannot be
    judged is a row with the reason. Run again, the command judges what is new.

    \b
    Examples:
      hexdbb fleet diagnose records -o results
      hexdbb fleet diagnose records -o results -m model.toml --workers 4
      hexdbb fleet diagnose s3://plant/records -o s3://plant/results --scheduler tcp://10.0.0.5:8786
    """
    _judge("diagnose", **options)


@command.command("discover")
@urls_argument
@output_option
@model_option
@again_option
@cluster_options
def discover_command(**options: Any) -> None:
    """Look for the effect that a model lacks in each of the records at URL...; one row a record and cause.

    URL, results and resuming are those of `hexdbb fleet diagnose`. A discovery takes seconds where a diagnosis takes
    some hundredths of one.

    \b
    Examples:
      hexdbb fleet discover records -o verdicts
      hexdbb fleet discover records -o verdicts -m model.toml --workers 4
    """
    _judge("discover", **options)


def _judge(
    what: str, urls: tuple[str, ...], output: str, model_path: Path | None, again: bool, cluster: ClusterOptions
) -> None:
    from hexdbb.fleet import fleet_results, judge_records, list_records  # pyarrow's dataset takes a while to import

    messages = message_console()

    def tell(line: str) -> None:
        messages.print(line, markup=False, soft_wrap=True)

    model = None if model_path is None else _model_text(model_path)
    with ExitStack() as stack:
        # A scheduler that does not answer is told before a million files are read; a local cluster waits for work.
        where = cluster if cluster.scheduler is None else stack.enter_context(connected(cluster, tell))
        with messages.status("listing records"):
            listing = list_records(urls, what, model, leave_out=output)
        for source, first in listing.copies:
            tell(f"{source}: a copy of {first}: judged once")
        with shown_progress(messages) as progress:
            run = judge_records(listing, fleet_results(output), where, again=again, tell=tell, progress=progress)
    say(f"{output}: {summary_text(run)}")


def _model_text(path: Path) -> str:
    """Return the text of a model file or machine file that can be read: it is refused here, not by every worker."""
    from hexdbb.fleet.judging import is_machine
    from hexdbb.machine import load_machine
    from hexdbb.model import load_model

    if not path.exists():
        raise InputError(f"{path}: no such file (expected a model file or a machine file)")
    text = read_text(path)
    if is_machine(text):
        load_machine(path)
    else:
        load_model(path)
    return text


@command.command("report")
@click.argument("url", metavar="RESULTS")
@click.option("-o", "--output", "page", metavar="FILE.html", type=click.Path(path_type=Path), help="Page to write.")
@click.option("--overwrite", is_flag=True, help="Replace an existing page.")
@json_option
def report_command(url: str, page: Path | None, overwrite: bool, as_json: bool) -> None:
    """Report on the fleet whose results lie at RESULTS.

    Which machines are worst, which effect grows where (slope with its 95 % interval), which values a batch or type of
    machine has in common, records far off the others of their machine, and records that could not be judged.

    \b
    Examples:
      hexdbb fleet report results
      hexdbb fleet report s3://plant/results -o fleet.html
      hexdbb fleet report results --json > fleet.json
    """
    from hexdbb.fleet import fleet_results
    from hexdbb.fleet.page import write_fleet_page
    from hexdbb.fleet.report import fleet_report

    if page is not None:
        if page.suffix != ".html":
            raise InputError(f"-o {page}: suffix {page.suffix!r} (expected .html)")
        refuse_existing(page, overwrite)
    messages = message_console()
    with messages.status("reading results") as status:
        found = fleet_report(fleet_results(url), status.update)
    if page is not None:
        write_fleet_page(found, page)
    if as_json:
        say(json.dumps(found.to_json(), indent=2, allow_nan=False))
    else:
        output_console().print(found.text(), markup=False, highlight=False, soft_wrap=True)
    if page is not None:
        messages.print(f"report: {page}", markup=False, highlight=False, soft_wrap=True)
