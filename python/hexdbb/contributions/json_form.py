"""Contributions to the circular deviation as JSON, declared."""

from __future__ import annotations

from dataclasses import dataclass

from hexdbb.files.results import JsonPart, JsonResult, NotNegative


@dataclass(frozen=True)
class PartJson(JsonPart):
    """One group of values inside a contribution."""

    effect: str
    """Name of the effect."""
    elements: tuple[str, ...]
    """Its elements meant; empty where all are."""
    circular_deviation_um: NotNegative
    """Circular deviation of its curve alone."""
    sigma_um: NotNegative
    """Standard uncertainty of this."""


@dataclass(frozen=True)
class ContributionJson(JsonPart):
    """One error, or several that are known only together."""

    label: str
    """Names of its parts."""
    parts: tuple[PartJson, ...]
    """One, or all those that are known only together; none for what the model does not explain."""
    circular_deviation_um: NotNegative
    """Circular deviation of its curve alone, both directions, mean over circles and feeds."""
    sigma_um: NotNegative
    """Standard uncertainty of this."""
    percent: NotNegative
    """The same in per cent of the measured circular deviation; the rows do not sum to 100: curves add like vectors."""
    without_um: NotNegative
    """Circular deviation of the measured circles with its curve taken out."""
    rms_um: NotNegative
    """Root mean square of its curve, centre and radius of each circle removed."""
    known: bool
    """Whether the readings determine it."""
    confounded_with: tuple[str, ...]
    """Contributions that it cannot be separated from."""


@dataclass(frozen=True)
class RecordContributionsJson(JsonPart):
    """What makes up the circular deviation of one record."""

    record: str
    """Name of the record."""
    circular_deviation_um: NotNegative | None
    """As measured, both directions, mean over circles and feeds; null where there are no rows."""
    rms_um: NotNegative | None
    """Root mean square radial deviation, centre and radius of each circle removed; null where there are no rows."""
    contributions: tuple[ContributionJson, ...]
    """Errors of machine and gauge, the largest circular deviation first."""
    not_explained: ContributionJson | None
    """What the model leaves, noise included."""
    set_up: tuple[ContributionJson, ...]
    """Where cup, ball and bar sit: no errors of the machine."""
    note: str
    """Why there are no rows; empty where there are."""


@dataclass(frozen=True)
class ContributionsJson(JsonResult):
    """Every error's part in the circular deviation, record by record."""

    SCHEMA = "hexdbb.contributions/1"

    records: tuple[RecordContributionsJson, ...]
    """In the order of the records."""
