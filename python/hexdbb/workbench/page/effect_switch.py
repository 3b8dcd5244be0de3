"""The switch of one effect of the model, as an element of the page: `effect_switch.js`."""

from __future__ import annotations

from collections.abc import Callable

from nicegui.element import Element


class EffectSwitch(Element, component="effect_switch.js"):
    """An effect taken part or left out; `on_turn` is called with its name and which of the two."""

    def __init__(self, effect: str, on_turn: Callable[[str, bool], None]) -> None:
        super().__init__()
        self._is_on = True
        self._props |= {"label": effect, "mark": f"switch {effect}", "first": True}
        self.on("turn", lambda event: self._turn(effect, bool(event.args), on_turn))

    def follow(self, is_on: bool) -> None:
        """Show what the session has."""
        if is_on != self._is_on:
            self._is_on = is_on
            self.run_method("set", is_on)

    def _turn(self, effect: str, is_on: bool, on_turn: Callable[[str, bool], None]) -> None:
        self._is_on = is_on
        on_turn(effect, is_on)
