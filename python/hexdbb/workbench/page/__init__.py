"""What the browser shows of a session, part by part; nothing here knows how a number is made.

Every tab has a `Page` of its own on the one session, and is drawn again when any tab changes it.
"""

from __future__ import annotations

from hexdbb.pages.serving import dress
from hexdbb.workbench.page.whole import Page
from hexdbb.workbench.session import Session


def show(session: Session, code_seconds: int | None) -> None:
    """Build the page of one tab; with an editor for effects of the user's own where they may compute (`Page`)."""
    dress()
    Page(session, code_seconds)


__all__ = ["Page", "show"]
