"""The effects of the model: each switched on or off, each value dragged; the charts follow."""

from __future__ import annotations

from nicegui import ui

from hexdbb.model import Parameter, Term
from hexdbb.workbench.page.effect_switch import EffectSwitch
from hexdbb.workbench.page.running import refused
from hexdbb.workbench.page.value_slider import ValueSlider
from hexdbb.workbench.session import Session


class EffectsPanel:
    """A row for each effect, its values inside."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._switches: dict[str, EffectSwitch] = {}
        self._values: list[ValueSlider] = []
        with ui.element("section").classes("wb-card").props('aria-labelledby="effects-title"'):
            with ui.row().classes("wb-title"):
                with ui.element("h2").props('id="effects-title"'):
                    ui.label("What the model has")
                self._back = ui.button("Back to the fit", on_click=session.back_to_fit).props("flat dense no-caps")
            ui.label("Switch an effect off, or drag a value: the charts follow; the model stays as it is.").classes(
                "wb-small"
            )
            self._rows = ui.element("div").classes("wb-effects")
        self.draw(anew=True)

    def draw(self, anew: bool) -> None:
        """Draw the switches and sliders as the session has them; all rows again where the model is another."""
        session = self._session
        self._back.set_enabled(not session.tried.is_nothing)
        if anew:
            self._build()
        for effect, switch in self._switches.items():
            switch.follow(effect not in session.tried.off)
        if self._values:
            shown = session.shown
            values = dict(zip((each.label for each in shown.parameters()), shown.values, strict=True))
            for each in self._values:
                each.follow(float(values[each.label]))

    def _build(self) -> None:
        self._switches, self._values = {}, []
        self._rows.clear()
        with self._rows:
            for term in self._ordered():
                self._row(term)

    def _ordered(self) -> list[Term]:
        """Return the effects, those added last first."""
        added = [step.effect for step in self._session.model.ledger if step.what == "add"]
        return sorted(
            self._session.model.terms, key=lambda term: -added.index(term.effect) - 1 if term.effect in added else 0
        )

    def _row(self, term: Term) -> None:
        info = self._session.model.info(term.effect)
        parameters = [each for each in self._session.model.parameters() if each.effect == term.effect]
        with ui.element("div").classes("wb-effect"):
            self._switches[term.effect] = EffectSwitch(term.effect, self._switch)
            with ui.expansion(term.effect, caption=info.physics).props("dense") as inside:
                opened = ui.element("div").classes("wb-values")
        inside.on_value_change(lambda event: self._fill(opened, parameters) if event.value else None)

    def _fill(self, opened: ui.element, parameters: list[Parameter]) -> None:
        """Make the sliders of an effect when it is opened first."""
        if opened.default_slot.children:
            return
        with opened:
            for each in parameters:
                if not each.is_coefficient:
                    self._slider(each)
            if parameters and parameters[0].is_coefficient:
                ui.label("A learned function: its coefficients are not values one by one.").classes("wb-small")

    def _slider(self, parameter: Parameter) -> None:
        shown = self._session.shown
        index = [each.label for each in shown.parameters()].index(parameter.label)
        value, sigma = float(shown.values[index]), float(shown.sigma[index])
        self._values.append(ValueSlider(parameter, value, sigma, self._drag))

    def _switch(self, effect: str, on: bool) -> None:
        refused(lambda: self._session.switch(effect, on))
        self._switches[effect].follow(effect not in self._session.tried.off)  # as before, where it was refused

    def _drag(self, label: str, value: float) -> None:
        refused(lambda: self._session.set_value(label, value))
