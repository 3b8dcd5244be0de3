"""The ledger of a model as text, as JSON, and as a table for a notebook."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from hexdbb.files.frames import html_table
from hexdbb.ledger.words import arrow, deed, sentence
from hexdbb.model import LedgerStep, Model


@dataclass(frozen=True)
class History:
    """Steps of a model's ledger, first to last."""

    steps: tuple[LedgerStep, ...]

    @property
    def text(self) -> str:
        """One sentence for each step, on a line of its own."""
        return "\n".join(sentence(step) for step in self.steps) or "nothing was done to this model yet"

    def to_json(self) -> dict[str, Any]:
        """Return the object that ``hexdbb history --json`` prints."""
        from hexdbb.ledger.json_form import HistoryJson, step_json  # only --json needs them

        return HistoryJson(tuple(step_json(step) for step in self.steps)).to_json()

    def _repr_html_(self) -> str:
        heads = ("step", "what", "error, µm RMS", "held-out circles, µm RMS", "records")
        rows = [
            [str(step.step), deed(step), _fitted(step), _held_out(step), ", ".join(step.records)] for step in self.steps
        ]
        return html_table(heads, rows)


def history(model: Model) -> History:
    """Return the ledger of a model."""
    return History(model.ledger)


def _fitted(step: LedgerStep) -> str:
    return arrow(step.rms_before_um, step.rms_after_um)


def _held_out(step: LedgerStep) -> str:
    if step.heldout_before_um is None or step.heldout_after_um is None:
        return "-"
    return arrow(step.heldout_before_um, step.heldout_after_um)
