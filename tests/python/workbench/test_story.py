"""The whole story in a real browser: open, see where it fails, ask, preview, add, read the error, undo, report."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect
from tests.browser.chromium import browser, opened
from tests.python.workbench.served import Served, drawn, marked, number, served, write

import hexdbb as hx

__all__ = ["browser"]


@pytest.fixture
def workbench(folder: Path) -> Iterator[Served]:
    with served(folder, "today.parquet", "-m", "model.toml") as started:
        yield started


def test_find_preview_add_undo_and_report_the_hidden_fault(browser: Browser, workbench: Served, folder: Path) -> None:
    with opened(browser, workbench.address) as page:
        drawn(page)
        expect(marked(page, "verdict")).to_contain_text("Something is missing")
        before_um = number(page, "rms")
        page.get_by_role("button", name="circle 3").first.click()
        expect(page.locator(".wb-polar b")).to_have_text(re.compile("circle 3"))
        marked(page, "ask").click()
        marked(page, "candidate backlash:4").wait_for()
        expect(marked(page, "verdict")).to_contain_text("Slider 4 has")
        marked(page, "preview backlash:4").click()
        expect(marked(page, "ladder")).to_contain_text("preview of backlash:4")
        previewed_um = number(page, "rms")
        assert previewed_um < 0.5 * before_um
        assert number(page, "fitted") == before_um
        assert hx.load_model(folder / "model.toml").term("backlash") is None
        marked(page, "add backlash:4").click()
        expect(marked(page, "ladder")).to_contain_text("added backlash of slider 4")
        expect(marked(page, "verdict")).to_contain_text("Nothing that matters is missing")
        assert number(page, "fitted") == pytest.approx(previewed_um, abs=0.02)
        assert hx.load_model(folder / "model.toml").ledger[-1].effect == "backlash"
        marked(page, "undo").click()
        expect(marked(page, "verdict")).to_contain_text("Something is missing")
        assert number(page, "rms") == before_um
        assert len(hx.load_model(folder / "model.toml").ledger) == 1
        write(page, "Report", "today-report.html")
        expect(page.get_by_text("today-report.html: written.")).to_be_visible()
    with opened(browser, (folder / "today-report.html").as_uri()) as report:
        expect(report.locator(".verdict")).to_contain_text("likely cause: slider 4 has")
