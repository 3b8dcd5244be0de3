"""The JSON of a discovery, declared."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from hexdbb.files.results import JsonPart, JsonResult, NotNegative, Share
from hexdbb.ledger.json_form import AddedJson, SizeJson


@dataclass(frozen=True)
class CandidateJson(JsonPart):
    """One hypothesis that was fitted."""

    effect: str
    """Name of the effect."""
    elements: tuple[int | str, ...]
    """Its elements, counted from 1; sides of the platform by their names."""
    rms_after_um: NotNegative
    """Root mean square residual with it."""
    bic_drop: float
    """Decrease of the Bayesian information criterion."""
    p_value: Share
    """Corrected for all candidates tried."""
    share: float
    """Part of what the model leaves unexplained that it explains."""
    parameters: tuple[SizeJson, ...]
    """Its values."""


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
    """Of the unexplained mean square, cross-validated."""
    period: float | None
    """Where it repeats."""
    unit: str
    """Of period and place."""
    place: tuple[float, float] | None
    """From where to where, where it is confined to one place, or between which samples something shifts."""
    size_um: NotNegative | None
    """Amplitude of what repeats, largest push at the place, or the shift."""
    sentence: str
    """All of it in words."""


@dataclass(frozen=True)
class DiscoveryJson(JsonResult):
    """Which effect is missing from a model."""

    SCHEMA = "hexdbb.discover/1"

    verdict: Literal["effect", "ambiguous", "none", "unknown"]
    """effect: it is known which; ambiguous: several are confounded; none: what is left is noise; unknown: no known
    effect explains it."""
    noise_um: NotNegative
    """Standard deviation of one reading."""
    rms_before_um: NotNegative
    """Root mean square residual of the model."""
    rms_after_um: NotNegative
    """With the best candidate."""
    heldout_before_um: NotNegative | None
    """On held-out circles; null with one circle."""
    heldout_after_um: NotNegative | None
    """With the best candidate."""
    candidates: tuple[CandidateJson, ...]
    """Best first."""
    ambiguous_with: tuple[str, ...]
    """Names of effects confounded with the best."""
    next_test: NextTestJson | None
    """Circle that would separate the candidates."""
    structure: tuple[StructureJson, ...]
    """Predictors of the remaining residual, largest share first."""
    remarks: tuple[str, ...]
    """Remarks, in sentences; effects of the user's own that were left out, with file and line."""
    steps: tuple[AddedJson, ...]
    """With --auto, what was done to the model, as hexdbb add prints it, schema aside; the rest is the last verdict."""
