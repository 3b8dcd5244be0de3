"""What `hexdbb trend --json` prints."""

from __future__ import annotations

from dataclasses import dataclass

from hexdbb.files.results import JsonPart, JsonResult, NotNegative


@dataclass(frozen=True)
class TrendRecordJson(JsonPart):
    """One record."""

    name: str
    """Its file."""
    sha256: str
    """Content hash."""
    measured: str
    """Time of its first sample, ISO 8601, UTC."""
    residual_um: NotNegative
    """Root mean square that the fit of all records leaves of its readings."""
    noise_um: NotNegative
    """Noise of one of its readings."""


@dataclass(frozen=True)
class ChangeJson(JsonPart):
    """One effect that changes between records."""

    what: str
    """Effect and element."""
    log_evidence: float
    """Gain of log evidence (natural logarithm) over one value for all records."""
    alternatives: tuple[str, ...]
    """Effects whose change would explain the same nearly as well."""


@dataclass(frozen=True)
class ExceededJson(JsonPart):
    """One limit that is exceeded."""

    what: str
    """Quantity, or effect and element."""
    parameter: str
    """Parameter of the effect; empty for a quantity."""
    limit: float
    """In `unit`."""
    unit: str
    """Unit of the limit."""
    since: str
    """Time of the record from which on it is beyond the limit."""
    until: str
    """Time of the last record beyond it."""
    alarm: bool
    """Whether it is beyond its alarm too."""


@dataclass(frozen=True)
class SegmentJson(JsonPart):
    """A stretch of time on one straight line."""

    since: str
    """Time of its first record."""
    until: str
    """Time of its last record."""
    level: float
    """Value at its first record."""
    per_month: float
    """Slope; 0 where it is constant."""


@dataclass(frozen=True)
class SeriesJson(JsonPart):
    """One value, record by record."""

    what: str
    """Quantity, or effect and element."""
    parameter: str
    """Parameter of the effect; empty for a quantity."""
    unit: str
    """Unit of all numbers of this value."""
    changing: bool
    """Whether the readings ask for it to change between records."""
    identifiable: bool
    """Whether its value is known, and not its change alone."""
    value: tuple[float | None, ...]
    """In the order of `records`."""
    sigma: tuple[float | None, ...]
    """Standard deviation of each value; null where not known."""
    change: tuple[float | None, ...]
    """Since the first record."""
    change_sigma: tuple[float | None, ...]
    """Standard deviation of each change."""
    segments: tuple[SegmentJson, ...]
    """Straight lines; a change point lies between two of them. Empty where nothing changes."""


@dataclass(frozen=True)
class TrendJson(JsonResult):
    """The trend of a machine's records."""

    SCHEMA = "hexdbb.trend/1"

    machine: str
    """Name of the machine."""
    status: int
    """Exit status: 0 fine, 3 beyond a limit, 4 beyond an alarm."""
    records: tuple[TrendRecordJson, ...]
    """In the order of their times."""
    changes: tuple[ChangeJson, ...]
    """What changes, strongest first."""
    exceeded: tuple[ExceededJson, ...]
    """What is beyond its limit."""
    series: tuple[SeriesJson, ...]
    """Every quantity and every effect's values."""
    notes: tuple[str, ...]
    """What else is to be known."""
