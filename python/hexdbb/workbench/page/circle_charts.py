"""The linked charts of one circle, as an element of the page: `circle_charts.js` draws them by `drawing`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nicegui.element import Element


class CircleCharts(Element, component="circle_charts.js", esm={"hexdbb-drawing": "drawing"}):
    """Polar, unrolled, and residual against a variable; a cursor marks one angle in all of them."""

    def __init__(self, on_ready: Callable[[], None], on_cursor: Callable[[float], None]) -> None:
        super().__init__()
        self.is_ready = False
        self.on("ready", lambda _: on_ready())
        self.on("cursor", lambda event: on_cursor(float(event.args)))

    def show(
        self, measured: dict[str, Any] | None, predicted: dict[str, Any], fitted: list[dict[str, str]] | None
    ) -> None:
        """Draw a circle (`CircleView`); `measured` is None where only the model changed, `fitted` where it stands."""
        self.run_method("show", measured, predicted, fitted)

    def settle(self, points: list[Any]) -> None:
        """Draw every reading's residual, and the axes anew, when what is dragged rests (`CircleView.points`)."""
        self.run_method("settle", points)
