"""What the browser shows of a session, part by part; nothing here knows how a number is made.

Every tab has a `Page` of its own on the one session, and is drawn again when any tab changes it.
"""

from __future__ import annotations

from pathlib import Path

from nicegui import ui

from hexdbb.workbench.page.whole import Page
from hexdbb.workbench.session import Session

ACCENT, GOOD, BAD = "#004B76", "#00523C", "#8C1D18"
"""Buttons, and messages of success and refusal: dark enough for white text on them, 7 to 1 and more."""
STYLE = (Path(__file__).parent / "style.css").read_text(encoding="utf-8")


def show(session: Session, allow_code: bool) -> None:
    """Build the page of one tab."""
    ui.add_css(STYLE)
    ui.colors(primary=ACCENT, positive=GOOD, negative=BAD)
    Page(session, allow_code)


__all__ = ["Page", "show"]
