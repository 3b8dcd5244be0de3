"""Actions of a page: run off the event loop, their progress shown, what they refuse said in one line."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any, Literal

from nicegui import run, ui

from hexdbb.errors import HexdbbError

Kind = Literal["positive", "warning", "negative"]
SECONDS_SHOWN = 12
"""Time for which a refusal stays on the screen: long enough to be read twice."""


def say(text: str, kind: Kind = "positive") -> None:
    """Show a message at the edge of the page."""
    seconds = SECONDS_SHOWN if kind == "negative" else SECONDS_SHOWN / 3
    ui.notify(text, type=kind, position="top", timeout=int(1000 * seconds), multi_line=True)


def refused(action: Callable[[], Any]) -> bool:
    """Run a short action at once; where it is refused say why and return True."""
    try:
        action()
    except (HexdbbError, OSError) as error:
        say(str(error), "negative")
        return True
    return False


def off_loop(action: Callable[[], Any], done: str = "") -> Callable[[], Awaitable[bool]]:
    """Return a handler that runs a long action in a thread, so that the page stays live, and says what it returns.

    The handler returns whether the action was done and its tab is still there, for what follows on the page; where it
    was refused it says why.

    What it has to say it says to the tab that is being built now: the button that was pressed may be gone by then.
    """
    tab = ui.context.client

    async def handle() -> bool:
        kind: Kind = "positive"
        try:
            returned = await run.io_bound(action)
            said = done or (returned if isinstance(returned, str) else "")
        except (HexdbbError, OSError) as error:
            said, kind = str(error), "negative"
        if tab.is_deleted:  # closed meanwhile: other tabs show what was done
            return False
        with tab:
            if said:
                say(said, kind)
        return kind == "positive"

    return handle
