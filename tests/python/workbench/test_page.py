"""The page in a real browser: names with HTML in them, accessibility, two tabs, files changed or gone meanwhile."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Locator, Page, expect
from tests.browser.chromium import browser, opened, violations
from tests.python.workbench.served import Served, drawn, marked, number, served, write

import hexdbb as hx
from hexdbb.compensation import read_compensation

__all__ = ["browser"]

MARKUP = "<img src=x onerror=alert(1)><b>bold"
EFFECTS = f"""
from hexdbb import effect

@effect(port="reading", unit="mm", prior_sigma=0.01, name={MARKUP + '"' + "'"!r})
def strange(samples):
    '''A <script>alert(2)</script> in the docstring.'''
    return samples["velocity_mm_s"][:, 0]
"""

SEEN = "seen"
LOOPS = f"""
from pathlib import Path
from time import sleep

from hexdbb import effect

@effect(port="reading", unit="mm", prior_sigma=0.01)
def endless(samples):
    while not Path({SEEN!r}).exists(): sleep(0.05)
    while True: pass
"""
"""It waits, which takes no processor time, until the test has seen what the page says meanwhile."""


@pytest.fixture
def workbench(folder: Path) -> Iterator[Served]:
    with served(folder, "today.parquet", "-m", "model.toml") as started:
        yield started


@pytest.fixture
def marked_up(folder: Path) -> Iterator[Served]:
    """Serve a record, a machine, a model and an effect whose names are HTML."""
    record = hx.read_record("today.parquet")
    record.machine = record.machine.model_copy(update={"name": MARKUP})
    hx.write_record(record, folder / f"{MARKUP}.parquet")
    (folder / "mine.py").write_text(EFFECTS, encoding="utf-8")
    (own,) = hx.load_effects("mine.py")
    model = hx.new_model(record.machine, ["leg_length", "cup_position", "bar_length"]).knowing_effects([own])
    hx.save_model(hx.add_effect(record, hx.diagnose(record, model).model, own.name).model, folder / f"{MARKUP}.toml")
    with served(folder, f"{MARKUP}.parquet", "-m", f"{MARKUP}.toml", "--effects", "mine.py") as started:
        yield started


def test_names_with_markup_are_shown_as_they_are(browser: Browser, marked_up: Served) -> None:
    with opened(browser, marked_up.address) as page:
        page.on("dialog", lambda dialog: pytest.fail(dialog.message))
        drawn(page)
        expect(marked(page, "about")).to_contain_text(MARKUP)
        expect(page.locator(".wb-effects")).to_contain_text(MARKUP)
        expect(page.locator(".wb-effects")).to_contain_text("A <script>alert(2)</script> in the docstring.")
        expect(marked(page, "ladder")).to_contain_text(MARKUP)
        page.locator(".wb-effects .q-expansion-item").first.click()
        marked(page, "Copy as script").click()
        expect(marked(page, "script-text")).to_contain_text("onerror=alert(1)")
        assert page.locator("img[src=x]").count() == 0


@pytest.mark.parametrize("width", [1440, 390])
def test_nothing_is_wrong_for_those_who_see_or_point_differently(
    browser: Browser, workbench: Served, width: int
) -> None:
    with opened(browser, workbench.address, width=width) as page:
        drawn(page)
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        page.locator(".wb-effects .q-expansion-item").first.click()
        marked(page, "value leg_length:1 longer").wait_for()
        page.wait_for_timeout(500)  # Quasar fades what it opens: contrast is that of the end
        assert violations(page) == []


def test_two_tabs_show_one_session(browser: Browser, workbench: Served) -> None:
    with opened(browser, workbench.address) as one, opened(browser, workbench.address, width=390) as other:
        drawn(one), drawn(other)
        before_um = number(other, "rms")
        marked(one, "switch leg_length").click()
        expect(marked(other, "rms")).not_to_have_text(f"{before_um:.2f}")
        expect(marked(other, "switch leg_length")).to_have_attribute("aria-checked", "false")
        other.get_by_role("button", name="Back to the fit").click()
        expect(marked(one, "rms")).to_have_text(f"{before_um:.2f}")
        expect(marked(one, "switch leg_length")).to_have_attribute("aria-checked", "true")


def test_a_value_follows_keyboard_and_mouse(browser: Browser, workbench: Served) -> None:
    label = "leg_length:1 longer"
    record, model = hx.read_record("today.parquet"), hx.load_model("model.toml")
    with opened(browser, workbench.address) as page:
        drawn(page)
        before_um = number(page, "rms")
        page.get_by_role("button", name="leg_length").click()
        slider = marked(page, f"value {label}")
        slider.locator("[tabindex='0']").focus()
        for _ in range(20):
            page.keyboard.press("ArrowRight")
        expect_rms(page, record, model, label, slider)
        assert number(page, "rms") > before_um
        assert number(page, "fitted") == before_um
        box = slider.bounding_box()
        assert box is not None
        page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
        page.mouse.down()
        for step in range(60):  # as fast as the browser takes them: what is drawn must not lag behind
            page.mouse.move(box["x"] + (0.5 + 0.005 * step) * box["width"], box["y"] + 0.5 * box["height"])
        page.mouse.up()
        expect_rms(page, record, model, label, slider)
        expect(marked(page, "circle").first).to_have_attribute("aria-pressed", "true")


def expect_rms(page: Page, record: hx.Record, model: hx.Model, label: str, slider: Locator) -> None:
    """Check that the page shows the very error of the model with the value that the slider has."""
    value = float(slider.get_attribute("aria-valuenow") or "nan")
    expected = hx.predict(record, hx.with_value(model, label, value)).rms_um
    expect(marked(page, "rms")).to_have_text(f"{expected:.2f}")


def compete(page: Page) -> None:
    """Press the editor's button by the keyboard: under a pointer it moves while the editor opens."""
    marked(page, "compete").press("Enter")


def test_a_model_changed_meanwhile_is_said_and_kept(browser: Browser, workbench: Served, folder: Path) -> None:
    with opened(browser, workbench.address) as page:
        drawn(page)
        other = hx.add_effect(hx.read_record("today.parquet"), hx.load_model("model.toml"), "backlash:4").model
        hx.save_model(other, "model.toml")
        written = (folder / "model.toml").read_bytes()
        marked(page, "undo").click()
        expect(page.get_by_role("alert")).to_contain_text("model.toml: was changed since it was opened")
        expect(page.locator(".wb-warning")).to_contain_text("changed on disk by another program")
        assert (folder / "model.toml").read_bytes() == written
        page.get_by_role("button", name="Reload").click()
        expect(marked(page, "ladder")).to_contain_text("added backlash of slider 4")


def test_a_record_that_is_gone_is_said(browser: Browser, workbench: Served, folder: Path) -> None:
    with opened(browser, workbench.address) as page:
        drawn(page)
        (folder / "today.parquet").unlink()
        marked(page, "switch leg_length").click()
        expect(page.locator(".wb-warning")).to_contain_text("today.parquet: no longer there")


def test_the_machine_follows_the_cursor_and_the_editor_needs_leave(browser: Browser, folder: Path) -> None:
    with (
        served(folder, "today.parquet", "-m", "model.toml", "--allow-code") as allowed,
        opened(browser, allowed.address) as page,
    ):
        drawn(page)
        marked(page, "3d").locator(".q-item").click()
        expect(page.locator(".wb-scene canvas")).to_be_visible()
        expect(page.locator(".wb-scene")).to_contain_text("as the model displaces it")
        cursor = page.get_by_label("Angle of the cursor in degrees")
        cursor.focus()
        page.keyboard.press("PageUp")
        expect(cursor).to_have_attribute("aria-valuenow", "10")
        expect(page.locator(".wb-readout")).to_contain_text("10°: counter-clockwise measured")
        marked(page, "editor").locator(".q-item").click()
        marked(page, "source").fill("x = 1\n")
        compete(page)
        expect(page.get_by_role("alert")).to_contain_text("my_effects.py: declares no effect")


def test_files_are_written_and_code_that_loops_is_stopped(browser: Browser, folder: Path) -> None:
    """Take away what the workbench writes, from a page that an effect without an end has not held up."""
    options = ("-m", "model.toml", "--allow-code", "--code-seconds", "2")
    with served(folder, "today.parquet", *options) as allowed, opened(browser, allowed.address) as page:
        drawn(page)
        marked(page, "editor").locator(".q-item").click()
        marked(page, "source").fill(LOOPS)
        compete(page)
        expect(page.get_by_role("status")).to_contain_text("trying my_effects.py")
        marked(page, "switch leg_length").click()  # the page answers meanwhile
        expect(marked(page, "switch leg_length")).to_have_attribute("aria-checked", "false")
        (folder / SEEN).touch()
        expect(page.get_by_role("alert")).to_contain_text("my_effects.py: did not end and was stopped")
        page.get_by_role("button", name="Back to the fit").click()
        with page.expect_download() as downloaded:
            write(page, "Report", "today-report.html")
        assert Path(downloaded.value.path()).read_bytes() == (folder / "today-report.html").read_bytes()
        expect(page.get_by_text("today-report.html: written.")).to_be_visible()
        write(page, "Report", "today-report.html")
        expect(page.get_by_text("today-report.html: exists already")).to_be_visible()
        write(page, "Compensation", "model.hexcomp")
        expect(page.get_by_text("model.hexcomp: written; left out: cup_position")).to_be_visible()
        assert read_compensation(folder / "model.hexcomp").left_out
        write(page, "Next circle", "today-next-plan.toml")
        expect(page.get_by_text("determines most of the machine's errors alone")).to_be_visible()
        assert len(hx.load_plan(folder / "today-next-plan.toml").circles) == 1


def test_without_leave_there_is_no_editor(browser: Browser, workbench: Served) -> None:
    with opened(browser, workbench.address) as page:
        drawn(page)
        assert marked(page, "source").count() == 0
