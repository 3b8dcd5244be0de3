"""The sections of a model file, as TOML has them: lengths in um, angles in urad, each unit named beside its value."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AliasChoices, Field

from hexdbb.files.validation import FileModel, NotNegative, Number, Positive, StrictModel
from hexdbb.machine import MachineFile

Names = Annotated[tuple[str, ...], Field(strict=False)]
Numbers = Annotated[tuple[Number, ...], Field(strict=False)]
Flags = Annotated[tuple[bool, ...], Field(strict=False)]
Sigmas = Annotated[tuple[Annotated[float, Field(allow_inf_nan=True)], ...], Field(strict=False)]


class ParameterEntry(StrictModel):
    """One value of an effect in its unit; without `sigma` it is not known on its own, free it may be fitted."""

    element: str
    name: str
    value: Number
    unit: str
    sigma: NotNegative | None = None
    identifiable: bool = False
    free: bool = True


class LearnedEntry(StrictModel):
    """What a learned effect is beyond its name: range of the variable, smoothness, prior, and the band of its fit.

    `low` and `high` are in the unit of the variable (of its logarithm where the function is one of a logarithm; of
    asinh(variable / warp_width) where `warp_width` is not 0).
    """

    low: Number
    high: Number
    splines: Annotated[int, Field(ge=1)]
    period: NotNegative = 0.0
    sign_width: NotNegative = 0.0
    since_s: Number = Field(validation_alias=AliasChoices("since_s", "middle_s"))
    """Time at which what grows is zero; earlier files call it `middle_s`, the middle of the record then."""
    span_s: Positive
    warp_width: NotNegative = 0.0
    roughness: Positive
    prior_sigma_um: Positive
    sigma_um: Numbers = ()
    samples: Numbers = ()


class EffectEntry(StrictModel):
    """One effect with its values, element by element; what a learned effect is stands in `learned`."""

    name: str
    learned: LearnedEntry | None = None
    parameters: tuple[ParameterEntry, ...] = Field(default=(), strict=False, alias="parameter")


class MountEntry(StrictModel):
    """A fixing of the cup: the record that has it, by the hash of its content, and its id there.

    Where several records share it, its name stands for them (``fixing NAME``).
    """

    record_sha256: str
    id: int


class SizeEntry(StrictModel):
    """One value of the effect a step added or removed, as it was found."""

    element: str
    name: str
    value: Number
    sigma: NotNegative | None = None
    unit: str


class StepEntry(StrictModel):
    """One step of the ledger; what was not looked at is left out."""

    step: int
    what: str
    effect: str = ""
    elements: Names = ()
    element_kind: str = ""
    rms_before_um: NotNegative
    rms_after_um: NotNegative
    peak_to_valley_before_um: NotNegative | None = None
    peak_to_valley_after_um: NotNegative | None = None
    heldout_before_um: NotNegative | None = None
    heldout_after_um: NotNegative | None = None
    heldout_peak_to_valley_before_um: NotNegative | None = None
    heldout_peak_to_valley_after_um: NotNegative | None = None
    records: Names = ()
    record_hashes: Names = ()
    sizes: tuple[SizeEntry, ...] = Field(default=(), strict=False, alias="size")


class EarlierEffectEntry(StrictModel):
    """One effect as it stood before a step: its values in the order and units of the effect's parameters.

    `sigma` is nan where a value was not known on its own, and left out where none was. `identifiable` is left out where
    none was, `free` where all were.
    """

    name: str
    values: Numbers
    sigma: Sigmas | None = None
    identifiable: Flags | None = None
    free: Flags | None = None
    learned: LearnedEntry | None = None


class EarlierEntry(StrictModel):
    """The model as it stood before a step of the ledger: what taking the step back gives.

    Mounts are only ever appended: `mounts` is how many of the file's there were.
    """

    before_step: int
    mounts: Annotated[int, Field(ge=0)]
    effects: tuple[EarlierEffectEntry, ...] = Field(default=(), strict=False, alias="effect")


class ModelFile(FileModel):
    """A model file, validated."""

    schema_id: Literal["hexdbb.model/1"] = Field(default="hexdbb.model/1", alias="schema")
    machine: MachineFile
    effects: tuple[EffectEntry, ...] = Field(default=(), strict=False, alias="effect")
    mounts: tuple[MountEntry, ...] = Field(default=(), strict=False, alias="mount")
    steps: tuple[StepEntry, ...] = Field(default=(), strict=False, alias="step")
    earlier: tuple[EarlierEntry, ...] = Field(default=(), strict=False)
