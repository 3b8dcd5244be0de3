"""Actions of a page: run off the event loop, their progress shown, what they refuse said in one line."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any

from nicegui import run, ui

from hexdbb.errors import HexdbbError

SECONDS_SHOWN = 12
"""Time for which a refusal stays on the screen: long enough to be read twice."""


def say(text: str, kind: str = "positive") -> None:
    """Show a message at the edge of the page; `kind` is positive, warning or negative."""
    ui.notify(text, type=kind, position="top", timeout=SECONDS_SHOWN * 1000 if kind == "negative" else 4000, multi_line=True)


def refused(action: Callable[[], Any]) -> bool:
    """Run a short action at once; where it is refused say why and return True."""
    try:
        action()
    except (HexdbbError, OSError) as error:
        say(str(error), "negative")
        return True
    return False


def off_loop(action: Callable[[], Any], done: str = "") -> Callable[[], Awaitable[bool]]:
    """Return a handler that runs a long action in a thread, so that the page stays live; it returns whether it was done."""

    async def handle() -> bool:
        try:
            await run.io_bound(action)
        except (HexdbbError, OSError) as error:
            say(str(error), "negative")
            return False
        if done:
            say(done)
        return True

    return handle
