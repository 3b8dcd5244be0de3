"""A text that follows a value that is dragged, without the page around it being rendered again."""

from __future__ import annotations

from nicegui.element import Element


class LiveText(Element, component="live_text.js"):
    """One line of text."""

    def __init__(self) -> None:
        super().__init__()
        self._text = ""
        self._is_ready = False
        self.on("ready", lambda _: self._begin())

    def set_text(self, text: str) -> None:
        """Show another text."""
        if text == self._text:
            return
        self._text = text
        if self._is_ready:
            self.run_method("set", text)
        else:
            self._props["first"] = text

    def _begin(self) -> None:
        self._is_ready = True
        self.run_method("set", self._text)
