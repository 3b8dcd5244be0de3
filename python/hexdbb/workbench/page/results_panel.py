"""What follows: compensation file, a model file of its own, the session as a script."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from nicegui import ui

from hexdbb.workbench.outputs import write_compensation, write_next_plan, write_report
from hexdbb.workbench.page.attributes import mark
from hexdbb.workbench.page.running import off_loop
from hexdbb.workbench.session import Session


class ResultsPanel:
    """Buttons that write files beside the model, and the session's script."""

    def __init__(self, session: Session) -> None:
        self._session = session
        with ui.element("section").classes("wb-card").props('aria-labelledby="results-title"'):
            with ui.element("h2").props('id="results-title"'):
                ui.label("Take it away")
            with ui.row().classes("wb-actions"):
                for name, action in (
                    ("Save model as", lambda: self._asked("model.toml", self._save)),
                    ("Report", lambda: self._asked("report.html", self._report, ui.download.file)),
                    ("Next circle", lambda: self._asked("next-plan.toml", self._plan)),
                    ("Compensation", lambda: self._asked(".hexcomp", self._compensate)),
                    ("Copy as script", self._script),
                ):
                    ui.button(name, on_click=action).props("outline dense no-caps").props(mark(name))

    def _default(self, ending: str) -> str:
        session = self._session
        stem = session.records[0].path or Path("record")
        base = session.file.path if session.file is not None else stem
        return str(base.with_suffix(ending)) if ending.startswith(".") else str(base.with_name(f"{stem.stem}-{ending}"))

    def _asked(self, ending: str, write: Callable[[Path], str], after: Callable[[Path], None] = lambda _: None) -> None:
        """Ask for the name of a file, write it, and do what follows."""
        with ui.dialog() as dialog, ui.card():
            name = ui.input("File", value=self._default(ending)).classes("wb-wide")

            writing = off_loop(lambda: write(Path(name.value)))

            async def go() -> None:
                dialog.close()
                if await writing():
                    after(Path(name.value))

            with ui.row():
                ui.button("Write", on_click=go).props("unelevated no-caps")
                ui.button("Cancel", on_click=dialog.close).props("flat no-caps")
        dialog.open()

    def _save(self, path: Path) -> str:
        self._session.save_as(path)
        return f"{path}: written; every further step is written there"

    def _compensate(self, path: Path) -> str:
        left_out = write_compensation(self._session, path)
        return "; ".join([f"{path}: written", *(f"left out: {name} ({why})" for name, why in left_out)])

    def _report(self, path: Path) -> str:
        return f"{path}: written. {write_report(self._session, path)}"

    def _plan(self, path: Path) -> str:
        return (
            f"{path}: written, a circle that {write_next_plan(self._session, path)}; hexdbb-run --plan {path} drives it"
        )

    def _script(self) -> None:
        text = self._session.script.text
        with ui.dialog() as dialog, ui.card().classes("wb-script"):
            ui.label("What was done here, in Python").classes("wb-sentence")
            ui.code(text, language="python").classes("wb-code").props(mark("script-text"))
            with ui.row():
                ui.button("Copy", on_click=lambda: ui.clipboard.write(text)).props("unelevated no-caps")
                ui.button("Close", on_click=dialog.close).props("flat no-caps")
        dialog.open()
