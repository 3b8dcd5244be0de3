"""What follows: compensation file, a model file of its own, the session as a script."""

from __future__ import annotations

from pathlib import Path

from nicegui import run, ui

from hexdbb.errors import HexdbbError
from hexdbb.workbench.page.running import say
from hexdbb.workbench.session import Session


class ResultsPanel:
    """Buttons that write files beside the model, and the session's script."""

    def __init__(self, session: Session) -> None:
        self._session = session
        with ui.element("section").classes("wb-card").props('aria-labelledby="results-title"'):
            with ui.element("h2").props('id="results-title"'):
                ui.label("Take it away")
            with ui.row().classes("wb-actions"):
                ui.button("Save model as", on_click=lambda: self._asked("model.toml", self._save)).props("outline dense no-caps")
                ui.button("Compensation", on_click=lambda: self._asked(".hexcomp", self._compensate)).props(
                    "outline dense no-caps"
                ).mark("compensation")
                ui.button("Copy as script", on_click=self._script).props("outline dense no-caps").mark("script")

    def _default(self, ending: str) -> str:
        session = self._session
        stem = session.records[0].path or Path("record")
        base = session.file.path if session.file is not None else stem
        return str(base.with_suffix(ending)) if ending.startswith(".") else str(base.with_name(f"{stem.stem}-{ending}"))

    def _asked(self, ending: str, write) -> None:  # type: ignore[no-untyped-def]
        """Ask for the name of a file, then write it."""
        with ui.dialog() as dialog, ui.card():
            name = ui.input("File", value=self._default(ending)).classes("wb-wide")

            async def go() -> None:
                dialog.close()
                try:
                    said = await run.io_bound(write, Path(name.value))
                    say(said)
                except (HexdbbError, OSError) as error:
                    say(str(error), "negative")

            with ui.row():
                ui.button("Write", on_click=go).props("unelevated no-caps")
                ui.button("Cancel", on_click=dialog.close).props("flat no-caps")
        dialog.open()

    def _save(self, path: Path) -> str:
        self._session.save_as(path)
        return f"{path}: written; every further step is written there"

    def _compensate(self, path: Path) -> str:
        left_out = self._session.write_compensation(path)
        return "; ".join([f"{path}: written", *(f"left out: {name} ({why})" for name, why in left_out)])

    def _script(self) -> None:
        text = self._session.script.text
        with ui.dialog() as dialog, ui.card().classes("wb-script"):
            ui.label("What was done here, in Python").classes("wb-sentence")
            ui.code(text, language="python").classes("wb-code").mark("script-text")
            with ui.row():
                ui.button("Copy", on_click=lambda: ui.clipboard.write(text)).props("unelevated no-caps")
                ui.button("Close", on_click=dialog.close).props("flat no-caps")
        dialog.open()
