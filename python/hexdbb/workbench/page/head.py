"""The head of the page: the verdict in one sentence, how large the error is, and on what."""

from __future__ import annotations

from nicegui import ui

from hexdbb.workbench.page.attributes import mark
from hexdbb.workbench.page.live_text import LiveText
from hexdbb.workbench.page.running import off_loop
from hexdbb.workbench.session import Session


class Head:
    """Record, model, verdict; the error shown and the noise as numbers."""

    def __init__(self, session: Session) -> None:
        self._session = session
        with ui.element("header").classes("wb-head"):
            with ui.element("div").classes("wb-verdict"):
                self._about = ui.label().classes("wb-about").props(mark("about"))
                self._verdict = ui.element("h1").props(mark("verdict"))
                with self._verdict:
                    self._sentence = ui.label()
                with ui.element("p").classes("wb-warning") as self._warning:
                    self._warned = ui.label()
                    self._reload = ui.button("Reload", on_click=off_loop(session.reload)).props("flat dense no-caps")
            with ui.element("div").classes("wb-numbers"):
                self._rms = _number("error shown, µm RMS", "rms")
                self._fitted = _number("as fitted", "fitted")
                self._noise = _number("noise of a reading", "noise")
        self.follow()
        self.settle()

    def follow(self) -> None:
        """Draw what follows a value that is dragged: the error shown."""
        self._rms.set_text(f"{self._session.prediction.rms_um:.2f}")

    def settle(self) -> None:
        """Draw the rest."""
        session = self._session
        model = "new model, not saved" if session.file is None else session.file.path.name
        records = ", ".join(record.name for record in session.records)
        self._about.set_text(f"{records}  ·  {model}  ·  {session.samples.machine.name}")
        self._fitted.set_text(f"{session.fitted.rms_um:.2f}")
        self._noise.set_text(f"{session.noise.noise.sigma_mm * 1e3:.2f}")
        kind, sentence = self._judged()
        self._sentence.set_text(sentence)
        self._verdict.classes(replace=f"wb-{kind}")
        self._draw_warning()

    def _judged(self) -> tuple[str, str]:
        session = self._session
        if not session.is_fitted:
            return (
                "open",
                f"Not fitted yet: the nominal machine misses the readings by {session.fitted.rms_um:.2f} µm RMS",
            )
        if session.found is not None:
            return ("good" if session.found.verdict == "none" else "bad"), _capital(session.found.sentence)
        enough = session.sufficiency
        if enough.is_sufficient:
            return "good", f"Nothing that matters is missing: {enough.sentence}"
        return "bad", f"Something is missing from the model: {enough.sentence}"

    def _draw_warning(self) -> None:
        changed = self._session.file is not None and self._session.file.is_changed
        gone = self._session.missing_records()
        said = []
        if changed and self._session.file is not None:
            said.append(f"{self._session.file.path}: changed on disk by another program; nothing is overwritten.")
        if gone:
            said.append(f"{', '.join(gone)}: no longer there; the readings are kept in memory.")
        self._warned.set_text(" ".join(said))
        self._warning.set_visibility(bool(said))
        self._reload.set_visibility(changed)


def _number(label: str, name: str) -> LiveText:
    with ui.element("div").classes("wb-number"):
        with ui.element("div").classes("wb-figure").props(mark(name)):
            number = LiveText()
        ui.label(label).classes("wb-small")
    return number


def _capital(sentence: str) -> str:
    return sentence[:1].upper() + sentence[1:]
