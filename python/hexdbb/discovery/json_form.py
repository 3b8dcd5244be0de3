"""The JSON of a discovery, declared."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from hexdbb.diagnosis.json_form import SufficiencyJson
from hexdbb.files.results import JsonPart, JsonResult, NotNegative
from hexdbb.ledger.json_form import AddedJson, SizeJson


@dataclass(frozen=True)
class HeldOutJson(JsonPart):
    """How a hypothesis predicts groups that were left out in turn."""

    left_out: Literal["circle", "feed", "direction", "lap"]
    """What a group is."""
    before_um: NotNegative
    """RMS error without the hypothesis."""
    after_um: NotNegative
    """RMS error with it."""
    share: float
    """Part of the unexplained mean square that it explains there; negative where it predicts worse."""


@dataclass(frozen=True)
class CandidateJson(JsonPart):
    """One set of hypotheses that was fitted."""

    names: tuple[str, ...]
    """The hypotheses, as hexdbb add takes them."""
    log_evidence: float
    """Natural logarithm of the evidence over that of the model as it is."""
    rms_after_um: NotNegative
    """Root mean square residual with it, its form's deviation explained."""
    share: float
    """Part of the unexplained mean square that it explains where it was fitted."""
    heldout: tuple[HeldOutJson, ...]
    """The same where it was not fitted; empty where that was not looked at."""
    refused: tuple[str, ...]
    """Why it is not admissible, in sentences; empty where it is."""


@dataclass(frozen=True)
class CauseJson(JsonPart):
    """One cause of what is missing."""

    choice: str
    """As hexdbb add takes it."""
    effect: str
    """Name of the effect."""
    elements: tuple[int | str, ...]
    """Its elements, counted from 1; sides of the platform by their names."""
    verdict: Literal["effect", "ambiguous", "none", "unknown"]
    """On this cause alone."""
    share: float
    """Part of the unexplained mean square that is left without it."""
    margin: float
    """Log evidence over the best explanation of another kind."""
    form_deviation: NotNegative
    """How far the machine's form is from the effect's, as a part of its size."""
    refinements: tuple[str, ...]
    """Learned functions at its place that describe the deviation."""
    function: str | None
    """The learned function that is this cause without its formula, as hexdbb add takes it; null where none is."""
    alike: tuple[str, ...]
    """The same effect at other elements, which explains the readings as well."""
    rivals: tuple[str, ...]
    """Hypotheses of another kind that explain the readings as well."""
    parameters: tuple[SizeJson, ...]
    """Its values."""
    clause: str
    """It in words."""


@dataclass(frozen=True)
class NextTestJson(JsonPart):
    """A circle as in a plan, and what it would show."""

    id: int
    """Id of the circle."""
    mount: int
    """Id of the mount it is run on."""
    radius_mm: float
    """Radius."""
    ball_offset_mm: tuple[float, float, float]
    """Ball in the platform frame."""
    plane_rpy_deg: tuple[float, float, float]
    """Orientation of the circle's plane: roll, pitch, yaw."""
    platform_rpy_deg: tuple[float, float, float]
    """Orientation of the platform: roll, pitch, yaw."""
    feeds_mm_min: tuple[float, ...]
    """Feed to run it at."""
    expected_sigmas: NotNegative
    """Distance of the two hypotheses that the circle is expected to show, in standard deviations."""
    between: tuple[str, str]
    """The two effects."""


@dataclass(frozen=True)
class StructureJson(JsonPart):
    """A variable that predicts part of what is unexplained."""

    variable: str
    """Name of the variable."""
    share: float
    """Explained part of the unexplained mean square, cross-validated."""
    period: float | None
    """Where it repeats."""
    unit: str
    """Unit of period and place."""
    place: tuple[float, float] | None
    """From where to where, where it is confined to one place, or between which samples something shifts."""
    size_um: NotNegative | None
    """Amplitude of what repeats, largest push at the place, or the shift."""
    sentence: str
    """All of it in words."""


@dataclass(frozen=True)
class DiscoveryJson(JsonResult):
    """What is missing from a model."""

    SCHEMA = "hexdbb.discover/2"

    verdict: Literal["effect", "ambiguous", "none", "unknown"]
    """effect: it is known which; ambiguous: several are confounded; none: nothing that matters is missing; unknown: no
    known effect explains it."""
    sentence: str
    """The answer in one sentence."""
    noise_um: NotNegative
    """Standard deviation of one reading."""
    rms_before_um: NotNegative
    """Root mean square residual of the model."""
    rms_after_um: NotNegative
    """With the known causes, in their exact form."""
    heldout_before_um: NotNegative | None
    """On held-out circles; null with one circle, or without causes."""
    heldout_after_um: NotNegative | None
    """With the causes."""
    sufficiency: SufficiencyJson
    """Whether the model is sufficient as it is: the answer of hexdbb diagnose."""
    causes: tuple[CauseJson, ...]
    """What is missing, the largest first."""
    candidates: tuple[CandidateJson, ...]
    """Hypotheses fitted: those of the verdict first, then by evidence."""
    remaining: SufficiencyJson | None
    """What remains with the known causes; null without any."""
    ambiguous_with: tuple[str, ...]
    """What explains the readings as well as the first cause."""
    next_test: NextTestJson | None
    """Circle that would separate the candidates."""
    structure: tuple[StructureJson, ...]
    """Predictors of the remaining residual, largest share first."""
    remarks: tuple[str, ...]
    """Remarks, in sentences."""
    refinements: tuple[str, ...]
    """Learned functions that describe the forms of effects in the model, where nothing else is missing."""
    calibrated: tuple[str, ...]
    """Effects that the model holds, as calibrated, and that were fitted, since the readings contradict it."""
    steps: tuple[AddedJson, ...]
    """With --auto, what was done to the model, as hexdbb add prints it, schema aside; the rest is the last verdict."""
    closing: str | None
    """With --auto, what was found and what is left, in one sentence."""
