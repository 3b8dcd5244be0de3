"""The circles to choose from, each with its error, as an element of the page."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from nicegui.element import Element


class CirclePicker(Element, component="circle_picker.js"):
    """A button for each circle and feed.

    Parameters
    ----------
    circles : sequence of (str, str)
        Name of each, and its feed.
    on_pick : callable
        Called with the place of the one that is pressed.
    """

    def __init__(self, circles: Sequence[tuple[str, str]], on_pick: Callable[[int], None]) -> None:
        super().__init__()
        self._shown: tuple[list[float], float, int] | None = None
        self._is_ready = False
        self._props["circles"] = [{"name": name, "feed": feed} for name, feed in circles]
        self.on("pick", lambda event: on_pick(int(event.args)))
        self.on("ready", lambda _: self._begin())

    def show(self, sizes_um: list[float], largest_um: float, current: int) -> None:
        """Show the error of each circle, µm RMS, bars up to the largest, and which one is shown."""
        self._shown = (sizes_um, largest_um, current)
        if self._is_ready:
            self.run_method("show", *self._shown)

    def _begin(self) -> None:
        self._is_ready = True
        if self._shown is not None:
            self.run_method("show", *self._shown)
