"""Every command that a page shows is run as it stands, and prints what the page says.

The commands of one page run one after another in an empty folder, as a reader would type them. What a page takes for
granted (a record, a model, a truth file) is prepared by `PREPARED`; what cannot run in a test stands in `NOT_RUN`, with
the reason.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from tests.documents.prepared import PREPARED
from tests.documents.printed import first_difference
from tests.documents.shown import Shown, shown_commands

ROOT = Path(__file__).parents[3]
NOT_RUN = {
    r"^make ": "builds the tree the test runs in, or calls this test",
    r"^\. ": "the test's interpreter is the environment",
    r"socketcan:can0": "needs a CAN interface",
    r"^(?:cmake|sudo|pip|git) ": "builds or installs; held by tests of their own",
}
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


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_commands_print_what_the_page_shows(page: Path, tmp_path: Path) -> None:
    name = str(page.relative_to(ROOT))
    commands = [each for each in shown_commands(page) if not any(re.search(why, each.command) for why in NOT_RUN)]
    if commands and name in PREPARED:
        PREPARED[name](tmp_path, run)
    for each in commands:
        check(each, tmp_path)


def check(shown: Shown, folder: Path) -> None:
    printed = run(shown.command, folder)
    if shown.output is None:
        return
    difference = first_difference(shown.output, printed.splitlines())
    assert difference is None, f"$ {shown.command}\n{difference}\n--- all of it ---\n{printed}"


def run(command: str, folder: Path) -> str:
    """Run a command line in a folder; return what it prints, progress included."""
    environment = {
        **os.environ,
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
        "COLUMNS": "120",
    }
    done = subprocess.run(
        ["bash", "-c", command],
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
        timeout=TIMEOUT_S,
    )
    assert done.returncode == 0, f"$ {command}\nexit status {done.returncode}\n{done.stdout}"
    return done.stdout
