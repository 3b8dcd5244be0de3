"""A report as ``hexdbb report --json`` prints it, declared."""

from __future__ import annotations

from dataclasses import dataclass

from hexdbb.contributions.json_form import RecordContributionsJson
from hexdbb.files.results import JsonPart, JsonResult, NotNegative


@dataclass(frozen=True)
class JudgedJson(JsonPart):
    """A quantity of one record against its tolerance."""

    record: str
    """Name of the record."""
    quantity: str
    """Symbol of ISO 230-4: G, G(b) or F."""
    tolerance_um: NotNegative
    """Largest value that passes."""
    worst_um: NotNegative | None
    """Largest value on any circle; null where it cannot be evaluated."""
    passes: bool | None
    """Whether it passes; null where it cannot be evaluated."""
    where: str
    """Circle, feed and direction of the largest value."""


@dataclass(frozen=True)
class ReportJson(JsonResult):
    """What a report says."""

    SCHEMA = "hexdbb.report/1"

    verdict: str
    """What the test found, in one sentence."""
    passes: bool | None
    """Whether every quantity with a tolerance passes; null where there is no tolerance."""
    judged: tuple[JudgedJson, ...]
    """Quantities with a tolerance."""
    contributions: tuple[RecordContributionsJson, ...]
    """Every error's part in the circular deviation, one table for each record."""
    unidentifiable: tuple[str, ...]
    """What the readings do not determine, in sentences."""
    next_steps: tuple[str, ...]
    """What to measure or do next, in sentences."""
