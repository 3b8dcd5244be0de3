"""The JSON of a fleet's report, declared."""

from __future__ import annotations

from dataclasses import dataclass

from hexdbb.files.results import Count, JsonPart, JsonResult, NotNegative, Share


@dataclass(frozen=True)
class MachineJson(JsonPart):
    """How a machine stands."""

    machine: str
    """Name and serial number, as folders of the results have it."""
    machine_name: str
    """Name in its machine file: its type."""
    batch: str | None
    """Batch that its newest record states."""
    records: Count
    """Records judged."""
    newest_utc: str | None
    """Time of its newest record."""
    deviation_um: NotNegative | None
    """Circular deviation G(b), else G, on its worst circle; median of the newest three records."""
    rms_after_um: NotNegative | None
    """Root mean square residual of the model; median of the newest three records."""
    verdict: str | None
    """Verdict of the newest record."""


@dataclass(frozen=True)
class GrowthJson(JsonPart):
    """A value of a machine that changes with time."""

    machine: str
    """Machine."""
    effect: str
    """Effect; empty for a quantity of ISO 230-4."""
    element: str
    """Element of the effect."""
    name: str
    """Name of the value, or symbol of the quantity."""
    unit: str
    """Unit of the value."""
    per_year: float
    """Slope, unit a year."""
    low: float
    """Lower limit of its 95 % interval."""
    high: float
    """Upper limit of its 95 % interval."""
    change: float
    """Change from the first record to the last."""
    at_last: float
    """Value at the last record."""
    records: Count
    """Records that the line goes through."""
    p: Share
    """Probability of such a slope by chance, before the correction for the number of slopes tried."""


@dataclass(frozen=True)
class SharedValueJson(JsonPart):
    """A value that a group of machines has in common."""

    kind: str
    """What groups machines: batch or type."""
    group: str
    """Which group."""
    effect: str
    """Effect; empty for a quantity of ISO 230-4."""
    element: str
    """Element; empty for the mean over all elements."""
    name: str
    """Name of the value, or symbol of the quantity."""
    unit: str
    """Unit of the value."""
    machines: Count
    """Machines of the group."""
    others: Count
    """Other machines."""
    mean: float
    """Mean over the group."""
    mean_of_others: float
    """Mean over the others."""
    low: float
    """Lower limit of the 95 % interval of their difference."""
    high: float
    """Upper limit of the 95 % interval of their difference."""
    p: Share
    """Probability of such a difference by chance, before the correction for the number tried."""


@dataclass(frozen=True)
class SharedCauseJson(JsonPart):
    """A cause found more often in a group of machines than outside."""

    kind: str
    """What groups machines: batch or type."""
    group: str
    """Which group."""
    effect: str
    """Cause that discoveries found."""
    having: Count
    """Machines of the group that have it."""
    machines: Count
    """Machines of the group that were looked into."""
    others_having: Count
    """Other machines that have it."""
    others: Count
    """Other machines that were looked into."""
    p: Share
    """Probability of so many in the group by chance, before the correction for the number tried."""


@dataclass(frozen=True)
class OutlierJson(JsonPart):
    """A record far off the others of its machine."""

    source: str
    """File of the record."""
    machine: str
    """Machine."""
    value: str
    """Value that is far off, in words."""
    found: float
    """The value."""
    expected: float | None
    """What the line through the others says; null where there is no line."""
    unit: str
    """Unit of the value."""


@dataclass(frozen=True)
class NotJudgedJson(JsonPart):
    """A record that could not be judged."""

    source: str
    """File of the record."""
    reason: str
    """Why."""


@dataclass(frozen=True)
class CopyJson(JsonPart):
    """A record that another file holds too."""

    source: str
    """File of the copy."""
    of: str
    """File that was counted."""


@dataclass(frozen=True)
class CauseJson(JsonPart):
    """A cause that discoveries found."""

    effect: str
    """The cause."""
    machines: tuple[str, ...]
    """Machines that have it."""


@dataclass(frozen=True)
class FleetReportJson(JsonResult):
    """What the results of a fleet say."""

    SCHEMA = "hexdbb.fleet.report/1"

    records: Count
    """Records judged."""
    machines: tuple[MachineJson, ...]
    """Machines, the worst first."""
    growing: tuple[GrowthJson, ...]
    """Values that change with time, more than chance explains."""
    shared_values: tuple[SharedValueJson, ...]
    """Values that a batch or a type of machine has in common, more than chance explains."""
    causes: tuple[CauseJson, ...]
    """Causes that discoveries found, the most frequent first."""
    shared_causes: tuple[SharedCauseJson, ...]
    """Causes that a batch or a type of machine has in common."""
    outliers: tuple[OutlierJson, ...]
    """Records far off the others of their machine."""
    not_judged: tuple[NotJudgedJson, ...]
    """Records that could not be judged."""
    copies: tuple[CopyJson, ...]
    """Records that were found twice, and counted once."""
