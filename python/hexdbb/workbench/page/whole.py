"""The page as a whole: what stands where, and what is drawn again when the session changes."""

from __future__ import annotations

import asyncio

from nicegui import ui

from hexdbb.workbench.page.circle_panel import CirclePanel
from hexdbb.workbench.page.editor_panel import EditorPanel
from hexdbb.workbench.page.effects_panel import EffectsPanel
from hexdbb.workbench.page.head import Head
from hexdbb.workbench.page.ladder import Ladder
from hexdbb.workbench.page.missing_panel import MissingPanel
from hexdbb.workbench.page.results_panel import ResultsPanel
from hexdbb.workbench.session import Session

REST_S = 0.12
"""Time without a change after which all is drawn: a value that is dragged changes every 0.05 s and oftener."""


class Page:
    """One tab.

    Parameters
    ----------
    session : Session
        Shared by all tabs.
    code_seconds : int or None
        Seconds that an effect of the user's own may compute when it is tried; None where none may be written here.
    """

    def __init__(self, session: Session, code_seconds: int | None) -> None:
        self._session = session
        self._client = ui.context.client
        self._loop = asyncio.get_running_loop()
        self._is_waiting = False
        self._resting: asyncio.TimerHandle | None = None
        self._model = session.model
        with ui.element("div").classes("wb-page"):
            self._head = Head(session)
            with ui.element("div").classes("wb-left"):
                self._missing = MissingPanel(session)
                self._ladder = Ladder(session)
            with ui.element("div").classes("wb-middle"):
                self._circle = CirclePanel(session)
            with ui.element("div").classes("wb-right"):
                self._effects = EffectsPanel(session)
                if code_seconds is not None:
                    EditorPanel(session, code_seconds)
                ResultsPanel(session)
        self._client.on_delete(session.changes.listen(self._heard))
        self._client.on_delete(self._end)

    def _heard(self) -> None:
        """Take note of a change, in whichever thread it was made; many at once are drawn once."""
        if not self._is_waiting:
            self._is_waiting = True
            self._loop.call_soon_threadsafe(self._draw)

    def _end(self) -> None:
        if self._resting is not None:
            self._resting.cancel()

    def _draw(self) -> None:
        """Draw curves and numbers at once, all that costs the browser more when nothing has changed for a moment."""
        self._is_waiting = False
        with self._client:
            self._circle.follow()
            self._head.follow()
        if self._resting is not None:
            self._resting.cancel()
        self._resting = self._loop.call_later(REST_S, self._settle)

    def _settle(self) -> None:
        self._resting = None
        with self._client:
            self._circle.settle()
            self._head.settle()
            self._missing.draw()
            self._effects.draw(anew=self._session.model is not self._model)
            self._ladder.draw()
        self._model = self._session.model
