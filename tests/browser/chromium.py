"""Headless Chromium for tests: one process a module, as Playwright allows one at a time; a page for each test.

A page allows no console error.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, Page, expect, sync_playwright

EXECUTABLES = ("chromium", "chromium-browser", "google-chrome")
HEIGHT = 900
RULES = {"runOnly": ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"]}
"""What axe-core checks: contrast, labels, roles, keyboard."""
TIMEOUT_MS = 60_000
"""Limits the wait for what a page shows in the end, on a machine that does much else."""
START_MS = 180_000
"""Limits the wait for the browser to start, six times as long as Playwright does: a slow test is better than none."""


def executable() -> str | None:
    """Return the browser of the distribution; None where there is none: Ubuntu has it as a snap only."""
    return next(filter(None, map(shutil.which, EXECUTABLES)), None)


def arguments() -> list[str]:
    """Return the options that it needs here: three dimensions drawn by software, no sandbox as root."""
    return ["--enable-unsafe-swiftshader", *(["--no-sandbox"] if os.geteuid() == 0 else [])]


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """Start the browser of the distribution; tests of pages are skipped where there is none."""
    found = executable()
    if found is None:
        pytest.skip(f"none of {', '.join(EXECUTABLES)} is installed")
    expect.set_options(timeout=TIMEOUT_MS)
    with sync_playwright() as driver:
        started = driver.chromium.launch(executable_path=found, args=arguments(), timeout=START_MS)
        yield started
        started.close()


@contextmanager
def opened(browser: Browser, address: str, width: int = 1440, dark: bool = False) -> Iterator[Page]:
    """Open a page of its own; whatever it writes to the console as an error, or fails to load, fails the test."""
    context = browser.new_context(viewport={"width": width, "height": HEIGHT}, color_scheme="dark" if dark else "light")
    page, wrong = context.new_page(), []
    page.set_default_timeout(TIMEOUT_MS)
    page.on("console", lambda said: wrong.append(said.text) if said.type == "error" else None)
    page.on("pageerror", lambda error: wrong.append(str(error)))
    page.on("requestfailed", lambda request: wrong.append(f"{request.url}: {request.failure}"))
    try:
        page.goto(address)
        yield page
        assert wrong == [], wrong
    finally:
        context.close()


def violations(page: Page) -> list[str]:
    """Return what axe-core finds wrong, one line for each kind, with the first places."""
    found = Axe().run(page, options=RULES).response["violations"]
    return [
        f"{each['id']}: {each['help']}: " + "; ".join(str(node["target"]) for node in each["nodes"][:3])
        for each in found
    ]
