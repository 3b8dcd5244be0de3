"""The page in a real browser: no error, nothing fetched, charts that answer, readable by everybody, on every width."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, Page
from tests.browser.chromium import browser
from tests.python.reporting.conftest import HOSTILE

from hexdbb.model import Model
from hexdbb.record import Record
from hexdbb.reporting import make_report, write_page
from hexdbb.samples import Samples

__all__ = ["browser"]  # a fixture

WIDTHS = (1440, 390)


@pytest.fixture(scope="module")
def said() -> list[str]:
    """Return what the page's console says, and what it tries to fetch."""
    return []


@pytest.fixture(scope="module")
def page(browser: Browser, page_file: Path, said: list[str]) -> Iterator[Page]:
    opened = browser.new_page(viewport={"width": WIDTHS[0], "height": 900})
    opened.on("console", lambda message: said.append(message.text))
    opened.on("pageerror", lambda error: said.append(str(error)))
    opened.on("request", lambda request: None if request.url.startswith("file:") else said.append(request.url))
    opened.goto(page_file.as_uri())
    yield opened
    opened.close()


def test_no_error_no_request_and_no_name_taken_for_html(page: Page, said: list[str]) -> None:
    assert said == []
    assert page.title().startswith("Circular test of <img")
    assert page.locator("img").count() == 0


@pytest.mark.parametrize("width", WIDTHS)
def test_the_page_fits_its_width_and_serves_everybody(page: Page, width: int) -> None:
    page.set_viewport_size({"width": width, "height": 900})
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    found = Axe().run(page)
    assert [(each["id"], each["nodes"][0]["target"]) for each in found.response["violations"]] == []


def test_the_cursor_tells_measured_predicted_and_residual(page: Page) -> None:
    circle = page.locator("article").first
    circle.locator("input[type=range]").fill("90")
    told = circle.locator(".cursor output").inner_text()
    assert told.startswith("90°")
    assert all(word in told for word in ("ccw: measured", "cw: measured", "predicted", "residual"))
    assert circle.locator("line.hand[visibility=visible]").count() == 2


def test_magnification_moves_the_paths_off_the_circle(page: Page) -> None:
    drawn = "document.querySelector('svg.polar path.measured').getAttribute('d').replaceAll('-0.00', '0.00')"
    before = page.evaluate(drawn)
    page.locator("#magnify").select_option("5")
    after = page.evaluate(drawn)
    assert after != before
    assert "magnified" in page.locator(".scale").first.inner_text()
    page.locator("#magnify").select_option("1")
    assert page.evaluate(drawn) == before


def test_a_direction_can_be_hidden(page: Page) -> None:
    line = page.locator("svg.polar path.measured.cw").first
    assert line.is_visible()
    page.locator("[data-series=cw]").uncheck()
    assert not line.is_visible()
    page.locator("[data-series=cw]").check()


def test_numbers_are_saved_and_tables_copied(page: Page) -> None:
    with page.expect_download() as waiting:
        page.locator("button.save").first.click()
    lines = Path(waiting.value.path()).read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith('"circle","feed_mm_min"') or lines[0].startswith("circle,feed_mm_min")
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.locator("#contributions button.copy").click()
    page.locator("#contributions button.copy", has_text="copied").wait_for()
    copied = page.evaluate("navigator.clipboard.readText()")
    assert "leg_length" in copied
    assert "\t" in copied


def test_everything_stands_on_the_page_without_script(browser: Browser, page_file: Path) -> None:
    still = browser.new_context(java_script_enabled=False).new_page()
    still.goto(page_file.as_uri())
    assert still.locator("svg.polar").count() == 8
    assert still.locator("svg.polar path.measured").first.is_visible()
    still.close()


def test_before_and_after_serve_everybody_too(browser: Browser, record: Record, model: Model, tmp_path: Path) -> None:
    later = replace(
        record,
        columns={**record.columns, "reading_um": 0.5 * record.columns["reading_um"]},
        metadata={"started": "2026-03-02T09:05:00+00:00"},
        path=Path("after.parquet"),
    )
    path = tmp_path / "change.html"
    write_page(make_report(Samples.of([record, later]), model, find_cause=False), path)
    page = browser.new_page(viewport={"width": WIDTHS[-1], "height": 900})
    page.goto(path.as_uri())
    assert [each["id"] for each in Axe().run(page).response["violations"]] == []
    page.get_by_role("link", name="Before and after").click()
    assert page.locator("#change h2").is_visible()
    conditions = page.locator("#conditions")
    assert HOSTILE in conditions.inner_text()
    assert "2026-03-02 09:05 UTC" in conditions.inner_text()
    page.close()
