"""An editor for an effect of the user's own; only where the workbench was started with --allow-code."""

from __future__ import annotations

from nicegui import ui

from hexdbb.workbench.session import Session


class EditorPanel:
    """The source of a user's effect."""

    def __init__(self, session: Session) -> None:
        self._session = session
        ui.label("editor")
