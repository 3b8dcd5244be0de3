"""The options of `hexdbb-run` for a page that watches the run, and its start."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Any

import click
from rich.console import Console

from hexdbb.capture.page_feed import watched_by_page
from hexdbb.capture.request import Request, RunProgress
from hexdbb.errors import InputError
from hexdbb.pages import MISSING


def watch_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add ``--watch`` and ``--no-browser``."""
    watch = click.option(
        "--watch",
        is_flag=True,
        help="Show the run in a page of this computer's browser, with a stop button; a process of its own.",
    )
    no_browser = click.option("--no-browser", is_flag=True, help="With --watch: print the address only.")
    return watch(no_browser(command))


def refuse_without_page(watch: bool) -> None:
    """Raise `InputError` where a page is asked for and cannot be served."""
    if watch and find_spec("nicegui") is None:
        raise InputError(f"--watch: {MISSING}")


@contextmanager
def watched(request: Request, progress: RunProgress, console: Console, watch: bool, no_browser: bool) -> Iterator[None]:
    """Let a page watch the run for the length of the context, if one is asked for, and print its address."""
    if not watch:
        yield
        return

    def ready(address: str) -> None:
        console.print(f"watch: {address}", highlight=False, soft_wrap=True)

    with watched_by_page(request, progress, not no_browser, ready):
        yield
