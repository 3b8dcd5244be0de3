"""The ledger of a model as text to be read aloud, as data, and as a table for a notebook."""

from __future__ import annotations

from dataclasses import asdict, dataclass
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
        """One sentence a step, a line each."""
        return "\n".join(sentence(step) for step in self.steps) or "nothing was done to this model yet"

    def to_json(self) -> dict[str, Any]:
        """Give the object that ``hexdbb history --json`` prints."""
        return {"steps": [step_json(step) for step in self.steps]}

    def _repr_html_(self) -> str:
        heads = ("step", "what", "error, µm RMS", "held-out circles, µm RMS", "records")
        rows = [
            [str(step.step), deed(step), _fitted(step), _held_out(step), ", ".join(step.records)] for step in self.steps
        ]
        return html_table(heads, rows)


def history(model: Model) -> History:
    """Give the ledger of a model."""
    return History(model.ledger)


def step_json(step: LedgerStep) -> dict[str, Any]:
    """Give one step as JSON has it: numbers of what was looked at, null elsewhere, and the sentence."""
    known = {name: value for name, value in vars(step).items() if name not in ("before", "sizes")}
    return {
        **known,
        "elements": list(step.elements),
        "records": list(step.records),
        "record_hashes": list(step.record_hashes),
        "sizes": [asdict(size) for size in step.sizes],
        "sentence": sentence(step),
        "can_be_undone": step.before is not None,
    }


def _fitted(step: LedgerStep) -> str:
    return arrow(step.rms_before_um, step.rms_after_um)


def _held_out(step: LedgerStep) -> str:
    if step.heldout_before_um is None or step.heldout_after_um is None:
        return "-"
    return arrow(step.heldout_before_um, step.heldout_after_um)
