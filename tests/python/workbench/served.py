"""The workbench as a process of its own, as a user starts it."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from playwright.sync_api import Locator, Page, expect

TIMEOUT_S = 60.0


@dataclass(frozen=True)
class Served:
    """Address of a workbench, with its token; its process."""

    address: str
    process: subprocess.Popen[str]

    @property
    def port(self) -> int:
        found = re.match(r"http://127\.0\.0\.1:(\d+)/\?token=\S+$", self.address)
        assert found is not None, self.address
        return int(found[1])

    @property
    def token(self) -> str:
        return self.address.partition("token=")[2]


@contextmanager
def served(folder: Path, *words: str) -> Iterator[Served]:
    """Start ``hexdbb workbench``; end it by Ctrl-C, after which it must have said nothing but its address."""
    command = [sys.executable, "-m", "hexdbb.cli", "workbench", *words, "--no-browser"]
    # NiceGUI serves otherwise where it believes to be part of a test.
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST")}
    process = subprocess.Popen(
        command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    try:
        address = process.stdout.readline().strip()
        assert address, process.communicate(timeout=TIMEOUT_S)[1]
        yield Served(address, process)
        process.send_signal(signal.SIGINT)
        said, errors = process.communicate(timeout=TIMEOUT_S)
        assert (process.returncode, said, errors) == (0, "", ""), errors
    finally:
        process.kill()
        with process:  # closes its pipes
            process.wait()


def marked(page: Page, name: str) -> Locator:
    """Return the part of the page of that name."""
    return page.locator(f'[data-mark="{name}"]')


def drawn(page: Page) -> int:
    """Return how often the charts were drawn, once they were."""
    charts = page.locator(".wb-circle[data-drawn]")
    charts.wait_for()
    return int(charts.get_attribute("data-drawn") or 0)


def number(page: Page, name: str) -> float:
    """Return a number of the page's head."""
    return float(marked(page, name).inner_text())


def write(page: Page, button: str, name: str) -> None:
    """Press a button that asks for the name of a file, and take the one that it proposes."""
    marked(page, button).click()
    dialog = page.get_by_role("dialog").last
    expect(dialog.get_by_label("File")).to_have_value(name)
    dialog.get_by_role("button", name="Write").click()
