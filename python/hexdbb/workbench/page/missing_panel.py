"""What is missing from the model: asked, ranked with reasons, previewed, added."""

from __future__ import annotations

from collections.abc import Awaitable, Callable

from nicegui import ui

from hexdbb.discovery import Candidate, Discovery
from hexdbb.workbench.changes import EVERYTHING
from hexdbb.workbench.page.attributes import mark
from hexdbb.workbench.page.running import off_loop, refused
from hexdbb.workbench.session import Session

GROUPS = {"circle": "circles", "feed": "feeds", "direction": "directions", "lap": "laps"}


class MissingPanel:
    """The first thing to do: fit, ask, preview, add."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._found_drawn: Discovery | None = None
        self._drawn: tuple[tuple[str, ...], bool] | None = None
        self._progress = ""
        with ui.element("section").classes("wb-card wb-first").props('aria-labelledby="missing-title"'):
            with ui.element("h2").props('id="missing-title"'):
                ui.label("What is missing?")
            with ui.row().classes("wb-actions"):
                self._fit = ui.button("Fit the model", on_click=off_loop(session.fit, "fitted"))
                self._ask = ui.button("What is missing?", on_click=off_loop(self._asking))
                for button, name in ((self._fit, "fit"), (self._ask, "ask")):
                    button.props("no-caps unelevated").props(mark(name))
            with ui.element("p").classes("wb-busy").props('role="status"') as self._busy:
                ui.spinner(size="1.2em")
                self._doing = ui.label()
            self._found = ui.element("div").classes("wb-found").props(mark("found"))
        self.draw()

    def draw(self) -> None:
        """Draw what has changed."""
        session = self._session
        self._fit.set_visibility(not session.is_fitted)
        self._ask.set_visibility(session.is_fitted)
        for button in (self._fit, self._ask):
            button.set_enabled(not session.changes.busy)
        self._busy.set_visibility(bool(session.changes.busy))
        self._doing.set_text(": ".join(filter(None, (session.changes.busy, self._progress))))
        now = (session.tried.preview, bool(session.changes.busy))
        if session.found is not self._found_drawn or now != self._drawn:
            self._found_drawn, self._drawn = session.found, now
            self._found.clear()
            with self._found:
                if session.found is not None:
                    self._draw_found(session.found)

    def _asking(self) -> None:
        def progress(what: str) -> None:
            self._progress = what
            self._session.changes.tell(EVERYTHING)

        try:
            self._session.ask(progress)
        finally:
            self._progress = ""

    def _draw_found(self, found: Discovery) -> None:
        ui.label(found.sentence[:1].upper() + found.sentence[1:] + ".").classes("wb-sentence")
        for cause in found.causes:
            if cause.rivals:
                ui.label(f"These readings cannot tell {cause.choice} from {' or '.join(cause.rivals)}.")
            elif cause.alike:
                ui.label(f"{', '.join(cause.alike)} would explain these readings as well.").classes("wb-small")
        if found.candidates:
            with ui.element("ol").classes("wb-ranking"):
                best = max(each.share for each in found.candidates) or 1.0
                for each in found.candidates:
                    self._candidate(each, best, found)
        for remark in found.remarks:
            ui.label(remark).classes("wb-small")
        if found.structure:
            ui.label("What the remaining residual follows:").classes("wb-small")
            for part in found.structure[:3]:
                ui.label(f"{part.share:.0%}  {part.sentence}").classes("wb-small")

    def _candidate(self, each: Candidate, best: float, found: Discovery) -> None:
        previewed = self._session.tried.preview == each.names
        is_answer = any(cause.choice in each.names for cause in found.causes) and found.verdict == "effect"
        with (
            ui.element("li")
            .classes("wb-candidate" + (" wb-answer" if is_answer else ""))
            .props(mark(f"candidate {each.choice}"))
        ):
            with ui.element("div").classes("wb-candidate-head"):
                ui.label(each.choice).classes("wb-candidate-name")
                ui.label(f"explains {each.share:.0%}").classes("wb-candidate-share")
            ui.element("span").classes("wb-bar").style(f"--part: {max(each.share, 0.0) / max(best, 1e-9):.3f}")
            ui.label(_reasons(each, found)).classes("wb-small")
            with ui.row().classes("wb-actions"):
                shown = "Back to the fit" if previewed else "Preview"
                preview = ui.button(shown, on_click=lambda: self._preview(each, previewed)).props(
                    "outline dense no-caps"
                )
                add = ui.button("Add", on_click=self._adding(each)).props("unelevated dense no-caps")
                for button, name in ((preview, "preview"), (add, "add")):
                    button.props(mark(f"{name} {each.choice}")).set_enabled(not self._session.changes.busy)

    def _preview(self, each: Candidate, previewed: bool) -> None:
        refused(self._session.back_to_fit if previewed else lambda: self._session.preview(*each.names))

    def _adding(self, each: Candidate) -> Callable[[], Awaitable[bool]]:
        return off_loop(lambda: self._session.add(*each.names), f"{each.choice} added")


def _reasons(each: Candidate, found: Discovery) -> str:
    """Return why a hypothesis stands where it does: what it leaves, on what it was not fitted to, why it is refused."""
    said = [f"{found.rms_before_um:.2f} → {each.rms_after_um:.2f} µm RMS"]
    left_out = [f"{GROUPS[name]} {group.after_um:.2f}" for name, group in each.heldout.items()]
    if left_out:
        said.append("where left out: " + ", ".join(left_out) + " µm")
    said.append(f"log evidence {each.log_evidence:,.0f}")
    said += [f"refused: {reason}" for reason in each.refused]
    return "; ".join(said)
