"""How the error fell, step by step: on the readings fitted and on circles held out; undo."""

from __future__ import annotations

from collections.abc import Sequence

from nicegui import ui

from hexdbb.ledger.words import deed
from hexdbb.model import LedgerStep, Model
from hexdbb.workbench.page.attributes import mark
from hexdbb.workbench.page.running import off_loop
from hexdbb.workbench.session import Session


class Ladder:
    """The ledger as bars."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._model: Model | None = None
        self._preview: tuple[str, ...] = ()
        with ui.element("section").classes("wb-card").props('aria-labelledby="ladder-title"'):
            with ui.row().classes("wb-title"):
                with ui.element("h2").props('id="ladder-title"'):
                    ui.label("How the error fell")
                self._undo = ui.button("Undo", on_click=off_loop(session.undo, "last step undone"))
                self._undo.props("outline dense no-caps").props(mark("undo"))
            self._rows = ui.element("div").classes("wb-ladder").props(mark("ladder"))
            ui.label("dark: readings fitted; light: circles held out of the fit; line: noise of a reading").classes(
                "wb-small"
            )
        self.draw()

    def draw(self) -> None:
        """Draw the steps, and what is previewed."""
        session = self._session
        self._undo.set_enabled(bool(session.model.ledger) and not session.changes.busy)
        if session.model is self._model and session.tried.preview == self._preview:
            return
        self._model, self._preview = session.model, session.tried.preview
        steps: Sequence[LedgerStep] = session.history.steps
        noise_um = session.noise.noise.sigma_mm * 1e3
        shown = [(deed(step), step.rms_after_um, step.heldout_after_um) for step in steps]
        if session.tried.preview:
            shown.append((f"preview of {' + '.join(session.tried.preview)}", session.prediction.rms_um, None))
        largest_um = max((held or fitted for _, fitted, held in shown), default=1.0)
        self._rows.clear()
        with self._rows:
            if not shown:
                ui.label("Nothing was done to this model yet.")
            elif steps:
                ui.label(f"before any fit: {steps[0].rms_before_um:.2f} µm RMS").classes("wb-small")
            for number, (what, fitted_um, held_um) in enumerate(shown, start=1):
                is_preview = number > len(steps)
                with ui.element("div").classes("wb-step" + (" wb-step-preview" if is_preview else "")):
                    ui.label(what if is_preview else f"{number}. {what}").classes("wb-step-name")
                    for size_um, name in ((fitted_um, "fitted"), (held_um, "held out")):
                        if size_um is not None:
                            self._bar(size_um, name, largest_um, noise_um)

    def _bar(self, size_um: float, name: str, largest_um: float, noise_um: float) -> None:
        with ui.element("div").classes("wb-step-bar"):
            kind = "wb-held" if name == "held out" else ""
            with ui.element("span").classes(f"wb-bar {kind}").style(f"--part: {size_um / largest_um:.3f}"):
                ui.element("i").style(f"left: {100.0 * min(noise_um / largest_um, 1.0):.1f}%")
            ui.label(f"{size_um:.2f} µm {name}").classes("wb-step-size")
