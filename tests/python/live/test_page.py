"""The page that watches a run, in headless Chromium: the trace grows, the button stops all six axes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from playwright.sync_api import Browser, Page, expect
from tests.browser.chromium import browser, opened, violations
from tests.python.capture.conftest import start_rig
from tests.python.live.watched import long_plan, watched

from hexdbb.capture.cia402 import DriveState
from hexdbb.record import read_record

__all__ = ["browser", "start_rig"]  # fixtures

LAPS = 200
"""More than a run gets through while a browser starts, on any computer: the button ends it."""
DRIVES = list(range(1, 7))


def points(page: Page) -> int:
    """Return how many points of the trace are drawn."""
    return int(page.locator(".wb-live-charts").get_attribute("data-points") or 0)


def has_points(page: Page, more_than: int) -> None:
    page.wait_for_function(f"Number(document.querySelector('.wb-live-charts').dataset.points) > {more_than}")


def test_the_trace_grows_and_the_button_stops_all_axes(
    browser: Browser, start_rig: Callable[..., object], tmp_path: Path
) -> None:
    (tmp_path / "plan.toml").write_text(long_plan(LAPS))
    with start_rig() as rig, watched(tmp_path, "--bus", rig.bus, "--lockstep", "--rate", 50, "--yes") as run:
        with opened(browser, run.address) as page:
            has_points(page, 0)
            has_points(page, points(page) + 100)
            expect(page.locator('[data-mark="place"]')).to_contain_text("counter-clockwise")
            expect(page.locator('[data-mark="times"]')).to_contain_text("99.9 % within")
            expect(page.locator('[data-mark="following"]')).to_contain_text("the run stops at 3 mm")
            rows = page.locator("tr[data-node]")
            expect(rows).to_have_count(7)
            for slot in range(6):
                expect(rows.nth(slot)).to_contain_text("operational")
                expect(rows.nth(slot)).to_contain_text("operation enabled")
            assert violations(page) == []
            page.get_by_role("button", name="Stop all axes").click()
            expect(page.locator('[data-mark="place"]')).to_contain_text("all six axes stopped")
            expect(page.locator('[data-mark="stop"]')).to_be_disabled()
        status, errors = run.finished()
        assert rig.states(DRIVES) == [DriveState.QUICK_STOP_ACTIVE] * 6
        assert rig.velocities(DRIVES) == [0] * 6
        # Stopped by the run, not by the rig when its controller had gone.
        assert "no client on the bus" not in rig.log.read_text()
    assert status == 1
    assert "error: hexdbb-run: interrupted by the user" in errors
    assert "Traceback" not in errors
    record = read_record(tmp_path / "run.parquet")
    assert not record.complete
    assert len(record) > 100
    reason = str(record.metadata["incomplete_because"])
    assert "interrupted by the user" in reason
    assert "all six axes stopped" in reason


def test_a_browser_that_disappears_changes_nothing(browser: Browser, tmp_path: Path) -> None:
    (tmp_path / "plan.toml").write_text(long_plan(4))
    with watched(tmp_path, "--rate", 50) as run:
        with opened(browser, run.address, width=390) as page:
            has_points(page, 0)
        status, errors = run.finished()
        assert status == 0, errors
        assert read_record(tmp_path / "run.parquet").complete
        # The page is there for a while, and says how it ended.
        with opened(browser, run.address) as page:
            expect(page.locator('[data-mark="place"]')).to_contain_text("The run is complete")
            expect(page.locator('[data-mark="stop"]')).to_be_disabled()
            assert points(page) == 0 or points(page) > 100
