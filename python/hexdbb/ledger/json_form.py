"""The JSON of a ledger, declared: its steps, a step that was added, a step that was undone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import Field

from hexdbb.diagnosis import Diagnosis
from hexdbb.files.results import Count, JsonPart, JsonResult, NotNegative
from hexdbb.ledger.words import sentence
from hexdbb.model import LedgerStep

Counted = Annotated[int, Field(ge=1)]


@dataclass(frozen=True)
class SizeJson(JsonPart):
    """One value of an effect."""

    element: str
    """Element, counted from 1."""
    name: str
    """Name of the value."""
    value: float
    """As fitted."""
    sigma: NotNegative | None
    """Standard deviation; null where it is not known on its own."""
    unit: str
    """Unit of value and sigma."""


@dataclass(frozen=True)
class StepJson(JsonPart):
    """One step of a model's ledger."""

    # Described by Field, not by the string below the field: AddedJson inherits these.
    step: Annotated[Counted, Field(description="Number of the step.")]
    what: Annotated[Literal["diagnose", "add", "remove"], Field(description="What was done.")]
    rms_before_um: Annotated[NotNegative, Field(description="Root mean square residual before.")]
    rms_after_um: Annotated[NotNegative, Field(description="After.")]
    records: Annotated[tuple[str, ...], Field(description="Names of the records used.")]
    record_hashes: Annotated[tuple[str, ...], Field(description="SHA-256 of their contents, in the same order.")]
    effect: Annotated[str, Field(description="Effect added or removed; empty where values were fitted only.")]
    elements: Annotated[tuple[str, ...], Field(description="Its elements; empty where all are meant.")]
    element_kind: Annotated[str, Field(description="What an element is: slider, guideway, leg, machine.")]
    sizes: Annotated[tuple[SizeJson, ...], Field(description="The effect's values.")]
    peak_to_valley_before_um: Annotated[
        NotNegative | None, Field(description="Largest minus smallest residual before.")
    ]
    peak_to_valley_after_um: Annotated[NotNegative | None, Field(description="After.")]
    heldout_before_um: Annotated[
        NotNegative | None,
        Field(description="Root mean square residual on held-out circles, before; null with one circle."),
    ]
    heldout_after_um: Annotated[NotNegative | None, Field(description="After.")]
    heldout_peak_to_valley_before_um: Annotated[NotNegative | None, Field(description="Peak to valley there, before.")]
    heldout_peak_to_valley_after_um: Annotated[NotNegative | None, Field(description="After.")]
    sentence: Annotated[str, Field(description="The step in one sentence.")]
    can_be_undone: Annotated[bool, Field(description="Whether the model before the step was kept.")]


@dataclass(frozen=True)
class AddedJson(StepJson, JsonResult):
    """One effect added to a model: the step of its ledger, and warnings."""

    SCHEMA = "hexdbb.add/1"

    warnings: tuple[str, ...]
    """What does not make sense in the fit, in sentences."""


@dataclass(frozen=True)
class HistoryJson(JsonResult):
    """The ledger of a model, first step to last."""

    SCHEMA = "hexdbb.history/1"

    steps: tuple[StepJson, ...]
    """Steps of the ledger."""


@dataclass(frozen=True)
class UndoneJson(JsonResult):
    """The step that was undone."""

    SCHEMA = "hexdbb.undo/1"

    undone: StepJson
    """The step that is no longer in the ledger."""
    steps_left: Count
    """Steps left in the ledger."""


def step_json(step: LedgerStep) -> StepJson:
    """Return one step as JSON has it: numbers of what was evaluated, None elsewhere, and the sentence."""
    return StepJson(**_keys(step))


def added_json(found: Diagnosis) -> AddedJson:
    """Return what ``hexdbb add --json`` prints of the diagnosis that `add_effect` returned."""
    return AddedJson(**_keys(found.model.ledger[-1]), warnings=found.warnings)


def _keys(step: LedgerStep) -> dict[str, Any]:
    known = {name: value for name, value in vars(step).items() if name not in ("before", "sizes")}
    return {
        **known,
        "sizes": tuple(SizeJson(**vars(size)) for size in step.sizes),
        "sentence": sentence(step),
        "can_be_undone": step.before is not None,
    }
