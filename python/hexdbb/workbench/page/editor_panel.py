"""An editor for effects of the user's own; only where the workbench was started with --allow-code.

The file is written and tried in a process of its own, which is stopped where it does not end; then its effects compete
with the known ones at the next question.
"""

from __future__ import annotations

from pathlib import Path

from nicegui import ui

from hexdbb.workbench.columns import variables
from hexdbb.workbench.outputs import write_effects
from hexdbb.workbench.page.attributes import mark
from hexdbb.workbench.page.running import off_loop, refused
from hexdbb.workbench.session import Session

FIRST = '''"""Effects of my own: functions of the table of samples that return the push per unit of their value."""

import numpy as np

from hexdbb import effect


@effect(port="reading", unit="mm", prior_sigma=0.01)
def my_effect(samples):
    """A push on the reading that follows the cosine of twice the angle."""
    return np.cos(2.0 * samples["angle_rad"])
'''
NAME = "my_effects.py"
ROWS = 24
"""Lines of the editor at first: those of `FIRST`, wrapped in its column, and some to write."""


class EditorPanel:
    """The source of the user's effects, the columns they may depend on."""

    def __init__(self, session: Session, code_seconds: int) -> None:
        self._session, self._code_seconds = session, code_seconds
        path = session.effects_path
        text = FIRST if path is None else path.read_text(encoding="utf-8")
        with ui.element("section").classes("wb-card").props('aria-labelledby="editor-title"'):
            with ui.element("h2").props('id="editor-title"'):
                ui.label("An effect of your own")
            with ui.expansion("Write it, and let it compete").props("dense").props(mark("editor")):
                self._file = ui.input("File", value=str(path or NAME)).props("dense outlined").classes("wb-wide")
                # Of one height, which the user changes: a page that shifts while one types moves what one presses next.
                self._text = ui.textarea(value=text).props(f'outlined rows={ROWS} input-class="wb-source"')
                self._text.props("spellcheck=false")
                self._text.props('aria-label="Source of the effects"').classes("wb-editor").props(mark("source"))
                columns = {key: f"{key}: {each.label}" for key, each in variables(session.samples).items()}
                ui.select(
                    columns, label="Columns of the state", with_input=True, on_change=lambda e: self._insert(e.value)
                )
                with ui.row().classes("wb-actions"):
                    compete = ui.button("Let it compete", on_click=off_loop(self._compete))
                    compete.props("unelevated dense no-caps").props(mark("compete"))
                    draft = ui.button("Draft from what was found", on_click=self._draft)
                    draft.props("outline dense no-caps").props(mark("draft"))

    def _insert(self, key: str | None) -> None:
        """Append how a column is written."""
        found = variables(self._session.samples).get(key or "")
        if found is not None:
            part = "" if found.part is None else f"[:, {found.part}]"
            self._text.value = f'{self._text.value.rstrip()}  # samples["{found.column}"]{part}\n'

    def _compete(self) -> str:
        names = write_effects(self._session, Path(self._file.value), self._text.value, self._code_seconds)
        self._session.ask()
        return f"{', '.join(names)}: competed"

    def _draft(self) -> None:
        def drafted() -> None:
            self._text.value = self._session.drafted()

        refused(drafted)
