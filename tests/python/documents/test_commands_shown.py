"""Every command that a page shows is run as it stands, and prints what the page says.

The commands of one page run one after another in an empty folder, as a reader would type them. What a page takes for
granted (a record, a model, a truth file) is prepared by `PREPARED`; what cannot run in a test stands in `NOT_RUN`, with
the reason.
"""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import click
import pytest
from tests.documents.measured import Measurements
from tests.documents.prepared import PREPARED
from tests.documents.printed import first_difference
from tests.documents.shown import Shown, shown_commands

from hexdbb.cli import cli
from hexdbb.cli.run import command as hexdbb_run

ROOT = Path(__file__).parents[3]
NOT_RUN = {
    r"^make ": "builds the tree the test runs in, or calls this test",
    r"^\. ": "the test's interpreter is the environment",
    r"socketcan:can0": "needs a CAN interface",
    r"^hexdbb check-realtime": "a minute long, and judges the computer; tests/python/capture/test_real_time.py runs it",
    r"^hexdbb workbench": "serves until it is ended, at an address drawn anew; tests/python/workbench opens it",
    r"(?:s3|tcp)://|^export |^dask ": "needs a store or a scheduler, which tests/python/fleet and cluster have",
    r"^(?:cmake|sudo|pip|git) ": "builds or installs; held by tests of their own",
}
PAGES_NOT_RUN = {
    "docs/closed-loop-learned.md": "24 circles for minutes, and a search of causes; `make closed-loop` does it",
    "docs/closed-loop.md": "250 readings a second for minutes; `make closed-loop` does it, five machines",
    "docs/studies.md": "hundreds of cases, one run at a store; tests/python/studies runs small ones",
    "docs/your-machine.md": "asks questions, and plans for a minute; tests/python/machine does both, coarser",
}
"""Of these commands only the options are checked."""
SERVES = re.compile(r"^hexdbb rig .*--port ")
"""What serves until it is ended: it stays in the background while the page's other commands run."""
TIMEOUT_S = 300.0
PAGES = [
    page
    for page in (
        ROOT / "README.md",
        *sorted((ROOT / "docs").rglob("*.md")),
        *sorted((ROOT / "firmware_interfaces").rglob("*.md")),
    )
    if shown_commands(page)
]
ENVIRONMENT = {
    **os.environ,
    "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
    "COLUMNS": "120",
}


@pytest.fixture(scope="module")
def measurements(tmp_path_factory: pytest.TempPathFactory) -> Measurements:
    return Measurements(tmp_path_factory.mktemp("measurements"))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_commands_print_what_the_page_shows(page: Path, tmp_path: Path, measurements: Measurements) -> None:
    name = str(page.relative_to(ROOT))
    if name in PAGES_NOT_RUN:
        for each in shown_commands(page):
            check_options(each.command)
        return
    commands = [each for each in shown_commands(page) if not any(re.search(why, each.command) for why in NOT_RUN)]

    def run_once(command: str, folder: Path) -> str:
        return measurements.run(command, folder, run)

    if commands and name in PREPARED:
        PREPARED[name](tmp_path, run_once)
    servers = [each.command for each in commands if SERVES.search(each.command)]
    with served(servers, tmp_path):
        for each in commands:
            if each.command not in servers:
                check(each, run_once(each.command, tmp_path))


def check(shown: Shown, printed: str) -> None:
    if shown.output is None:
        return
    difference = first_difference(shown.output, printed.splitlines())
    assert difference is None, f"$ {shown.command}\n{difference}\n--- all of it ---\n{printed}"


def check_options(command: str) -> None:
    """Parse a command line as the program does, without running it."""
    program, *words = shlex.split(command, comments=True)
    assert program in ("hexdbb", "hexdbb-run"), command
    chosen: click.Command | None = hexdbb_run
    if program == "hexdbb":
        chosen = cli.get_command(click.Context(cli), words.pop(0))
    assert chosen is not None, command
    chosen.make_context(program, words)


@contextmanager
def served(commands: list[str], folder: Path) -> Iterator[None]:
    """Start commands that serve, wait for the line that each prints when it is ready, and end them afterwards."""
    started = []
    try:
        for command in commands:
            process = subprocess.Popen(
                ["bash", "-c", f"exec {command}"], cwd=folder, env=ENVIRONMENT, stdout=subprocess.PIPE, text=True
            )
            started.append(process)
            assert process.stdout is not None
            promised = command.partition("# prints: ")[2]
            assert process.stdout.readline().strip() == promised, command
        yield
    finally:
        for process in started:
            process.terminate()
            process.communicate(timeout=TIMEOUT_S)


def run(command: str, folder: Path) -> str:
    """Run a command line in a folder; return what it prints, progress included."""
    done = subprocess.run(
        ["bash", "-c", command],
        cwd=folder,
        env=ENVIRONMENT,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
        timeout=TIMEOUT_S,
    )
    assert done.returncode == 0, f"$ {command}\nexit status {done.returncode}\n{done.stdout}"
    return done.stdout
