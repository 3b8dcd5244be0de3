"""The JSON of a diagnosis, declared."""

from __future__ import annotations

from dataclasses import dataclass

from hexdbb.diagnosis.noise import Source
from hexdbb.files.results import Count, JsonPart, JsonResult, NotNegative, Share, number_or_none
from hexdbb.model import Model


@dataclass(frozen=True)
class ValueJson(JsonPart):
    """One value of a model."""

    effect: str
    """Name of the effect."""
    element: str
    """Element it belongs to, counted from 1."""
    name: str
    """Name of the value."""
    value: float
    """Most probable value."""
    sigma: NotNegative | None
    """Standard deviation; null where the value is not known on its own."""
    unit: str
    """Unit of value and sigma."""
    identifiable: bool
    """Whether the readings determine it on its own."""


@dataclass(frozen=True)
class PlaceSigmaJson(JsonPart):
    """Standard deviations of the ball's position, µm."""

    median: NotNegative
    """Over the places considered."""
    worst: NotNegative
    """The largest of them."""


@dataclass(frozen=True)
class SufficiencyJson(JsonPart):
    """Whether a model is sufficient."""

    sufficient: bool
    """Whether nothing that matters is missing."""
    significant: bool
    """Whether what is left differs from noise."""
    unexplained_um: NotNegative
    """RMS of what is left beyond the noise."""
    matters_um: NotNegative
    """Unexplained RMS from which it matters."""
    level: float
    """Excess of the residual over the noise, in standard deviations of that excess."""
    whiteness_p: Share
    """Probability of so smooth a residual by chance."""
    sentence: str
    """All of it in words."""


@dataclass(frozen=True)
class DiagnosisJson(JsonResult):
    """Values of a model's effects that explain measured readings best."""

    SCHEMA = "hexdbb.diagnose/1"

    rms_before_um: NotNegative
    """Root mean square residual at the start of the fit."""
    rms_after_um: NotNegative
    """Root mean square residual of the fit."""
    noise_um: NotNegative
    """Standard deviation of one reading."""
    noise_source: Source
    """Where the noise comes from."""
    heldout_before_um: NotNegative | None
    """Root mean square residual on held-out circles, with the start's values; null with one circle."""
    heldout_after_um: NotNegative | None
    """The same with the values fitted to the other circles."""
    rank: Count
    """Combinations of the machine's own errors that the readings determine."""
    condition: float
    """Condition number of these combinations."""
    usable: bool
    """Whether the fit ended in a usable solution."""
    parameters: tuple[ValueJson, ...]
    """Every value of the model, effect by effect, element by element."""
    sufficiency: SufficiencyJson
    """Whether the model is sufficient: the answer of hexdbb discover."""
    unidentifiable: tuple[str, ...]
    """What the readings do not determine, in sentences."""
    warnings: tuple[str, ...]
    """What does not make sense in the fit, in sentences."""
    place_sigma_um: PlaceSigmaJson
    """Standard deviation of the ball's position over the workspace, a rigid shift of the base aside."""


def value_json(model: Model) -> tuple[ValueJson, ...]:
    """Return every value with name, uncertainty and unit."""
    columns = model.columns()
    return tuple(
        ValueJson(
            effect=columns["effect"][row],
            element=columns["element"][row],
            name=columns["name"][row],
            value=float(columns["value"][row]),
            sigma=number_or_none(columns["sigma"][row]),
            unit=columns["unit"][row],
            identifiable=bool(columns["identifiable"][row]),
        )
        for row in range(len(columns["value"]))
    )
