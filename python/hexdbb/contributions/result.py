"""Contributions to the circular deviation, ranked: as objects, text, JSON and data frame."""

from __future__ import annotations

from dataclasses import dataclass, field
from html import escape
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb.contributions.json_form import ContributionJson, ContributionsJson, PartJson, RecordContributionsJson
from hexdbb.contributions.text import cells, contributions_text
from hexdbb.files.frames import html_table, to_frame
from hexdbb.files.plain_text import plain_text

Floats = NDArray[np.float64]


NOT_EXPLAINED = "not explained by the model"


@dataclass(frozen=True)
class Part:
    """One group of values inside a contribution.

    Attributes
    ----------
    effect, elements : str, tuple of str
        No elements mean all.
    label, physics : str
        Name, and what it is in a sentence.
    circular_deviation_um : float
        Of its curve alone, mean over the circles.
    sigma_um : float
        Standard uncertainty of this.
    """

    effect: str
    elements: tuple[str, ...]
    label: str
    physics: str
    circular_deviation_um: float
    sigma_um: float


@dataclass(frozen=True)
class Contribution:
    """One error, or several that the readings determine only together, and what it does to the circles of a record.

    Attributes
    ----------
    parts : tuple of Part
        One, or all those that are known only together.
    circular_deviation_um : float
        Circular deviation of its curve alone, both directions, mean over circles and feeds: that of a machine which is
        perfect but for this.
    sigma_um : float
        Standard uncertainty of this, from what the readings leave open of its values.
    percent : float
        The same in per cent of the measured circular deviation. Curves add like vectors: the per cent of all rows do
        not sum to 100.
    without_um : float
        Circular deviation of the measured circles with its curve taken out: what would be left if it were mended.
    rms_um : float
        Root mean square of its curve, centre and radius of each circle removed.
    by_circle_um : tuple of float
        `circular_deviation_um` of each circle, in the order of `RecordContributions.circles`.
    is_known : bool
        Whether the readings determine it.
    confounded_with : tuple of str
        Labels of other contributions that it cannot be separated from.
    """

    parts: tuple[Part, ...]
    circular_deviation_um: float
    sigma_um: float
    percent: float
    without_um: float
    rms_um: float
    by_circle_um: tuple[float, ...]
    is_known: bool
    confounded_with: tuple[str, ...] = ()

    @property
    def label(self) -> str:
        """Names of its parts: ``guideway_translation + slider_offset``; of what has none, that it is not explained."""
        return " + ".join(part.label for part in self.parts) or NOT_EXPLAINED


@dataclass(frozen=True)
class RecordContributions:
    """What makes up the circular deviation of one record.

    Attributes
    ----------
    record_name : str
    circles : tuple of (int, float)
        Id and feed, mm/min, of the full circles.
    measured_um : float
        Circular deviation as measured, both directions (ISO 230-4: G(b)), mean over the circles.
    measured_by_circle_um : tuple of float
    rms_um : float
        Root mean square radial deviation, centre and radius of each circle removed.
    rows : tuple of Contribution
        Errors of the machine and of the gauge, the largest circular deviation first.
    set_up : tuple of Contribution
        Where cup, ball and bar sit; apart, because it is no error of the machine and moves centre and radius only.
    not_explained : Contribution or None
        What the model leaves of the readings, noise included.
    note : str
        Why there are no rows; empty where there are.
    """

    record_name: str
    circles: tuple[tuple[int, float], ...]
    measured_um: float
    measured_by_circle_um: tuple[float, ...]
    rms_um: float
    rows: tuple[Contribution, ...]
    set_up: tuple[Contribution, ...]
    not_explained: Contribution | None
    note: str = ""

    @classmethod
    def without_rows(cls, record_name: str, note: str) -> RecordContributions:
        """Return the table of a record that has none, with the reason."""
        return cls(record_name, (), 0.0, (), 0.0, (), (), None, note)


@dataclass(frozen=True)
class Contributions:
    """Contributions to the circular deviation, one table for each record."""

    records: tuple[RecordContributions, ...] = field(default=())

    def json_form(self) -> ContributionsJson:
        """Return them as declared for JSON."""
        return ContributionsJson(tuple(_record_json(each) for each in self.records))

    def to_json(self) -> dict[str, Any]:
        """Return them as one object: micrometres, per cent."""
        return self.json_form().to_json()

    def columns(self) -> dict[str, NDArray[Any]]:
        """Return one row for each contribution of each record, in the order of rank, one array a column."""
        rows = [(table.record_name, rank, kind, each) for table in self.records for rank, kind, each in _ranked(table)]
        return {
            "record": np.array([name for name, *_ in rows], dtype=object),
            "rank": np.array([rank for _, rank, *_ in rows], dtype=np.int64),
            "kind": np.array([kind for _, _, kind, _ in rows], dtype=object),
            "contribution": np.array([each.label for *_, each in rows], dtype=object),
            "circular_deviation_um": np.array([each.circular_deviation_um for *_, each in rows], dtype=np.float64),
            "sigma_um": np.array([each.sigma_um for *_, each in rows], dtype=np.float64),
            "percent": np.array([each.percent for *_, each in rows], dtype=np.float64),
            "without_um": np.array([each.without_um for *_, each in rows], dtype=np.float64),
            "rms_um": np.array([each.rms_um for *_, each in rows], dtype=np.float64),
            "known": np.array([each.is_known for *_, each in rows], dtype=np.bool_),
            "confounded_with": np.array([", ".join(each.confounded_with) for *_, each in rows], dtype=object),
        }

    def to_frame(self) -> Any:
        """Return `columns` as a ``pandas.DataFrame``; `InputError` where pandas is not installed."""
        return to_frame(self.columns())

    def __str__(self) -> str:
        return plain_text(contributions_text(self))

    def _repr_html_(self) -> str:
        return "".join(f"<p>{escape(table.record_name)}</p>{html_table(*cells(table))}" for table in self.records)


def _ranked(table: RecordContributions) -> list[tuple[int, str, Contribution]]:
    """Return rank from 1, kind and contribution; what is not ranked has rank 0."""
    ranked = [(rank, "machine", each) for rank, each in enumerate(table.rows, start=1)]
    left = [] if table.not_explained is None else [(0, "not explained", table.not_explained)]
    return [*ranked, *left, *((0, "set-up", each) for each in table.set_up)]


def _record_json(table: RecordContributions) -> RecordContributionsJson:
    return RecordContributionsJson(
        record=table.record_name,
        circular_deviation_um=None if table.note else table.measured_um,
        rms_um=None if table.note else table.rms_um,
        contributions=tuple(_json(each) for each in table.rows),
        not_explained=None if table.not_explained is None else _json(table.not_explained),
        set_up=tuple(_json(each) for each in table.set_up),
        note=table.note,
    )


def _json(each: Contribution) -> ContributionJson:
    return ContributionJson(
        label=each.label,
        parts=tuple(
            PartJson(part.effect, part.elements, part.circular_deviation_um, part.sigma_um) for part in each.parts
        ),
        circular_deviation_um=each.circular_deviation_um,
        sigma_um=each.sigma_um,
        percent=each.percent,
        without_um=each.without_um,
        rms_um=each.rms_um,
        known=each.is_known,
        confounded_with=each.confounded_with,
    )
