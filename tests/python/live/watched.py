"""`hexdbb-run --watch` as a process, as a user starts it, and the process of its page."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from signal import SIGKILL

from tests.circle_plan import circle_plan

TIMEOUT_S = 120.0
ADDRESS = re.compile(r"watch: (http://127\.0\.0\.1:\d+/\?token=\S+)$")


def long_plan(laps: int) -> str:
    """Return the text of a plan: so many laps of one circle, counter-clockwise, then clockwise."""
    return circle_plan().replace("laps = 1", f"laps = {laps}").replace("directions = [1]", "directions = [1, -1]")


@dataclass(frozen=True)
class Watched:
    """A run, the address of its page, and the process of that."""

    process: subprocess.Popen[str]
    address: str
    page: int

    def finished(self) -> tuple[int, str]:
        """Wait for the end of the run; return exit status and stderr."""
        _, errors = self.process.communicate(timeout=TIMEOUT_S)
        return self.process.returncode, errors


@contextmanager
def watched(folder: Path, *words: object) -> Iterator[Watched]:
    """Start a run of `plan.toml` in lockstep, recorded in `run.parquet`, with a page but no browser."""
    program = Path(sys.executable).with_name("hexdbb-run")
    standing = ("--plan", "plan.toml", "-o", "run.parquet", "--watch", "--no-browser")
    # NiceGUI serves otherwise where it believes to be part of a test.
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST")}
    process = subprocess.Popen(
        [str(program), *map(str, (*standing, *words))],
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stderr is not None
    page = None
    try:
        said = process.stderr.readline()
        found = ADDRESS.match(said)
        assert found, said + process.stderr.read()
        page = page_of(process.pid)
        yield Watched(process, found[1], page)
    finally:
        with suppress(ProcessLookupError):
            if page is not None:
                os.kill(page, SIGKILL)
        process.kill()
        with process:  # closes its pipes
            process.wait()


def page_of(run: int) -> int:
    """Return the process of the page that a run has started."""
    for each in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):
            parent = each.joinpath("stat").read_text().rpartition(")")[2].split()[1]
            if int(parent) == run and b"hexdbb.live" in each.joinpath("cmdline").read_bytes():
                return int(each.name)
    raise AssertionError(f"process {run} has no page")
