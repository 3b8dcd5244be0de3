"""Options of commands that run many tasks: where they run; how far they are, on stderr."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import click
from rich.console import Console

from hexdbb.cluster import ClusterOptions, Progress, Summary

LINE_EVERY_S = 30.0
"""Time between two lines of progress where stderr is no terminal: a log of a night has a thousand."""
GIB = 2.0**30
OPTIONS = (
    click.option("--workers", type=int, metavar="N", help="Processes on this computer.  [default: its cores]"),
    click.option("--scheduler", metavar="URL", help="Use a scheduler of Dask: tcp://HOST:PORT or tls://HOST:PORT."),
    click.option("--tls-ca", type=click.Path(path_type=Path), help="TLS: authority of the certificates (PEM)."),
    click.option("--tls-cert", type=click.Path(path_type=Path), help="TLS: certificate of this command (PEM)."),
    click.option("--tls-key", type=click.Path(path_type=Path), help="TLS: key of this certificate (PEM)."),
)


def cluster_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options that say where tasks run; the command takes them as `cluster`, a `ClusterOptions`."""

    @functools.wraps(command)
    def with_cluster(
        *args: Any,
        workers: int | None,
        scheduler: str | None,
        tls_ca: Path | None,
        tls_cert: Path | None,
        tls_key: Path | None,
        **others: Any,
    ) -> Any:
        return command(*args, cluster=ClusterOptions(workers, scheduler, tls_ca, tls_cert, tls_key), **others)

    for option in reversed(OPTIONS):
        with_cluster = option(with_cluster)
    return with_cluster


@contextmanager
def shown_progress(messages: Console) -> Iterator[Callable[[Progress], None]]:
    """Yield what shows how far a run is: a line that changes on a terminal, else a line now and then."""
    last_s = 0.0

    def log(now: Progress) -> None:
        nonlocal last_s
        if now.elapsed_s - last_s >= LINE_EVERY_S:
            last_s = now.elapsed_s
            messages.print(progress_text(now), markup=False)

    if not messages.is_terminal:
        yield log
        return
    with messages.status("starting workers") as status:
        yield lambda now: status.update(progress_text(now))


def progress_text(now: Progress) -> str:
    """Return how far a run is, and when it is expected to end."""
    end = "" if now.remaining_s is None else f", ends {_at(now.remaining_s)}"
    failed = f", {now.failed} failed" if now.failed else ""
    return f"{now.before + now.done:,} of {now.total:,} done{failed}{end}"


def summary_text(run: Summary) -> str:
    """Return what a run did, in one line."""
    if not run.done:
        return f"{run.total:,} of {run.total:,} were done before: nothing to do"
    before = f", {run.before:,} done before" if run.before else ""
    failed = f", {run.failed:,} failed" if run.failed else ""
    return (
        f"{run.done:,} done in {run.elapsed_s:.1f} s ({run.done / run.elapsed_s:.1f}/s){failed}{before};"
        f" memory of a worker: at most {run.peak_bytes / GIB:.2f} GiB"
    )


def _at(remaining_s: float) -> str:
    """Return the time of day, with the date where it is another day."""
    now = datetime.now().astimezone()
    end = now + timedelta(seconds=remaining_s)
    return end.strftime("%H:%M:%S" if end.date() == now.date() else "%Y-%m-%d %H:%M")
