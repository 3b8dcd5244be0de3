"""Times of the workbench as its user has them, measured in headless Chromium.

``python -m tests.browser.workbench_times [FOLDER]``: makes records of about 35,000 and 100,000 readings and a model
fitted to them in FOLDER (kept, so that a second run is quick), opens each in the workbench and prints a table: first
paint, a toggle until the new curve is on the screen, values of a slider drawn in a second.
"""

from __future__ import annotations

import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import numpy as np
from playwright.sync_api import Page, sync_playwright
from tests.browser.chromium import HEIGHT, arguments, executable
from tests.python.workbench.served import drawn, marked, served

import hexdbb as hx
from hexdbb_truth.cases import case
from hexdbb_truth.simulate import Pace

RATES_HZ = {35_000: 20.0, 100_000: 57.0}
"""Readings a second that give about so many readings of the standard plan."""
TOGGLES, DRAG_S = 12, 3.0
SETTLED_MS = 800
"""After a toggle, until its time is read: to ask the page meanwhile whether it has drawn takes time of its own."""
EFFECT, VALUE = "leg_length", "leg_length:1 longer"
PAINTED = """() => {
  const painted = performance.getEntriesByName('first-contentful-paint')[0];
  return painted ? painted.startTime : null;
}"""
NOTED = """() => {
  window.drawnAt = [];
  new MutationObserver(() => requestAnimationFrame(() => setTimeout(() => window.drawnAt.push(performance.now()), 0)))
    .observe(document.querySelector('.wb-circle'), {attributes: true, attributeFilter: ['data-drawn']});
  document.addEventListener('pointerdown', () => { window.pressedAt = performance.now(); }, true);
}"""
"""A curve is on the screen when the frame in which it was drawn has ended."""


@dataclass(frozen=True)
class Times:
    """What one record took."""

    readings: int
    paint_s: float
    charts_s: float
    toggles_ms: list[float]
    updates_per_s: float


def record_in(folder: Path, readings: int) -> tuple[str, str]:
    """Make a record and a model fitted to it, unless they are there; return their names."""
    record_name, model_name = f"{readings}.parquet", f"{readings}.toml"
    if not (folder / model_name).exists():
        pace = Pace(rate_hz=RATES_HZ[readings], instants_per_sample=4, travel_s=10.0)
        record = case("backlash-x3-s1", pace).record()
        hx.write_record(record, folder / record_name)
        few = record.part(np.arange(len(record)) % 8 == 0)
        hx.save_model(hx.diagnose(few, hx.new_model(record.machine)).model, folder / model_name)
    return record_name, model_name


def times_of(page: Page, address: str, readings: int) -> Times:
    """Open a workbench and measure it."""
    page.goto(address)
    drawn(page)
    charts_s = page.evaluate("performance.now()") / 1e3
    paint_s = page.evaluate(PAINTED) / 1e3
    page.wait_for_timeout(1000)
    page.evaluate(NOTED)
    toggles_ms = []
    for _ in range(TOGGLES):
        page.evaluate("window.drawnAt = []")
        marked(page, f"switch {EFFECT}").click()
        page.wait_for_timeout(SETTLED_MS)
        toggles_ms.append(page.evaluate("window.drawnAt[0] - window.pressedAt"))
    page.get_by_role("button", name=EFFECT).click()
    slider = marked(page, f"value {VALUE}")
    slider.wait_for()
    page.wait_for_timeout(800)
    return Times(readings, paint_s, charts_s, toggles_ms, _dragged(page, slider.bounding_box() or {}))


def _dragged(page: Page, box: dict[str, float]) -> float:
    """Drag a slider back and forth; return the curves drawn in a second."""
    y = box["y"] + box["height"] / 2.0
    page.mouse.move(box["x"] + box["width"] / 2.0, y)
    page.mouse.down()
    page.evaluate("window.drawnAt = []; window.beginsAt = performance.now()")
    steps, ends_s = 0, time.monotonic() + DRAG_S
    while time.monotonic() < ends_s:
        steps += 1
        page.mouse.move(box["x"] + box["width"] * (0.5 + 0.4 * np.sin(0.15 * steps)), y)
    page.mouse.up()
    count, span_ms = page.evaluate("[window.drawnAt.length, window.drawnAt.at(-1) - window.beginsAt]")
    return 1e3 * count / span_ms


def main(folder: Path) -> None:
    """Print the table."""
    print("| readings | first paint, s | charts drawn, s | toggle to curve, ms (median, largest) | drag, curves/s |")
    print("|---|---|---|---|---|")
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=executable(), args=arguments())
        for readings in RATES_HZ:
            record, model = record_in(folder, readings)
            with served(folder, record, "-m", model) as workbench:
                page = browser.new_page(viewport={"width": 1440, "height": HEIGHT})
                found = times_of(page, workbench.address, len(hx.read_record(folder / record)))
                page.close()
            toggle = f"{median(found.toggles_ms):.0f}, {max(found.toggles_ms):.0f}"
            times = f"{found.paint_s:.2f} | {found.charts_s:.2f} | {toggle} | {found.updates_per_s:.0f}"
            print(f"| {found.readings:,} | {times} |", flush=True)
        browser.close()


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with tempfile.TemporaryDirectory() as made:
            main(Path(made))
