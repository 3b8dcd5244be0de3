"""The rows of a fleet's results as records, and as values record by record of one machine.

A record that was judged twice, once from each of two files that hold it, counts once: content decides, not names.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from numpy.typing import NDArray

from hexdbb.comparison import QUANTITIES
from hexdbb.trend.series import WATCHED_QUANTITIES

Floats = NDArray[np.float64]
Row = dict[str, Any]

OF_RECORD = (
    *("task", "machine", "source", "record", "machine_name", "batch", "measured_utc", "command", "model", "verdict"),
    *("rms_after_um", *(f"{key}_um" for key in WATCHED_QUANTITIES)),
)
OF_VALUE = ("task", "effect", "element", "name", "unit", "value", "sigma")
READ = tuple(dict.fromkeys((*OF_RECORD, *OF_VALUE, "error")))
SECONDS_PER_DAY = 86400.0


@dataclass(frozen=True, order=True)
class ValueName:
    """Which value: of an effect's element, or a quantity of ISO 230-4, which has neither parameter nor sigma."""

    effect: str
    element: str
    name: str
    unit: str = field(compare=False)

    @property
    def words(self) -> str:
        """For people: ``backlash:4 play``, ``G(b)``."""
        return f"{':'.join(filter(None, (self.effect, self.element)))} {self.name}".strip()


@dataclass(frozen=True, eq=False)
class Series:
    """One value of one machine, in the order of time.

    Attributes
    ----------
    machine : str
    value_name : ValueName
    days : ndarray, shape (n,)
        Since 1970.
    value, sigma : ndarray, shape (n,)
        sigma is nan for a quantity.
    sources : tuple of str
        Files of the records.
    """

    machine: str
    value_name: ValueName
    days: Floats
    value: Floats
    sigma: Floats
    sources: tuple[str, ...]


@dataclass(frozen=True)
class Observed:
    """What the rows of a dataset say.

    Attributes
    ----------
    records : tuple of dict
        Columns `OF_RECORD` of every record judged, one a record and command, in the order of time.
    series : tuple of Series
        Values that the readings determine, and quantities, of records with a time.
    causes : tuple of (str, str)
        Machine and effect of every cause that discoveries found, once each.
    looked_into : frozenset of str
        Machines of which a record was looked into by a discovery.
    not_judged : tuple of (str, str)
        Source and reason.
    copies : tuple of (str, str)
        Source of a record that another file holds too, and that file.
    groups : mapping of str
        ``batch`` and ``type`` of every machine that states one: the group of each machine by its name.
    """

    records: tuple[Row, ...]
    series: tuple[Series, ...]
    causes: tuple[tuple[str, str], ...]
    looked_into: frozenset[str]
    not_judged: tuple[tuple[str, str], ...]
    copies: tuple[tuple[str, str], ...]
    groups: Mapping[str, Mapping[str, str]]


def observe(rows: pa.Table) -> Observed:
    """Return what rows say; they have the columns `READ`."""
    failed = rows.filter(pc.is_valid(rows["error"]))
    good = rows.filter(pc.is_null(rows["error"]))
    first: dict[str, Row] = {}
    for row in good.select(OF_RECORD).to_pylist():
        first.setdefault(row["task"], row)
    records, copies = _each_once(sorted(first.values(), key=lambda row: (_time(row), row["source"])))
    known = {row["task"]: row for row in records}
    values = good.filter(pc.and_(pc.is_valid(good["effect"]), pc.is_in(good["task"], pa.array(list(known)))))
    fitted = values.filter(pc.and_(pc.is_valid(values["sigma"]), pc.is_valid(values["value"])))
    diagnosed = [
        (known[row["task"]], row)
        for row in fitted.select(OF_VALUE).to_pylist()
        if known[row["task"]]["command"] == "diagnose"
    ]
    causes = {
        (known[task]["machine"], effect)
        for task, effect in zip(values["task"].to_pylist(), values["effect"].to_pylist(), strict=True)
        if known[task]["command"] == "discover"
    }
    return Observed(
        tuple(records),
        tuple(_series(diagnosed, records)),
        tuple(sorted(causes)),
        frozenset(row["machine"] for row in records if row["command"] == "discover"),
        tuple(sorted(zip(failed["source"].to_pylist(), failed["error"].to_pylist(), strict=True))),
        tuple(copies),
        _groups(records),
    )


def _each_once(ordered: Sequence[Row]) -> tuple[list[Row], list[tuple[str, str]]]:
    """Return the records, each once for a command and model, and which files hold one that another holds."""
    kept: dict[tuple[str, str, str], Row] = {}
    copies = []
    for row in ordered:
        same = kept.setdefault((row["record"], row["command"], row["model"]), row)
        if same is not row:
            copies.append((row["source"], same["source"]))
    return list(kept.values()), copies


def _time(row: Mapping[str, Any]) -> datetime:
    return row["measured_utc"] or datetime.min


def _series(diagnosed: Sequence[tuple[Row, Row]], records: Sequence[Row]) -> list[Series]:
    symbols = {each.key: each.symbol for each in QUANTITIES}
    found: dict[tuple[str, ValueName], list[tuple[float, float, float, str]]] = {}

    def add(record: Row, name: ValueName, value: float, sigma: float) -> None:
        if record["measured_utc"] is not None:
            days = record["measured_utc"].replace(tzinfo=UTC).timestamp() / SECONDS_PER_DAY
            found.setdefault((record["machine"], name), []).append((days, value, sigma, record["source"]))

    for record, row in diagnosed:
        add(record, ValueName(row["effect"], row["element"], row["name"], row["unit"]), row["value"], row["sigma"])
    seen: set[str] = set()
    for record in records:
        if record["record"] in seen:  # judged by another command too: its readings are the same
            continue
        seen.add(record["record"])
        for key in WATCHED_QUANTITIES:
            if (value := record[f"{key}_um"]) is not None:
                add(record, ValueName("", "", symbols[key], "um"), value, np.nan)
    return [_ordered(machine, name, points) for (machine, name), points in sorted(found.items())]


def _ordered(machine: str, name: ValueName, points: list[tuple[float, float, float, str]]) -> Series:
    days, values, sigmas, sources = zip(*sorted(points), strict=True)
    return Series(machine, name, np.array(days), np.array(values), np.array(sigmas), sources)


def _groups(records: Sequence[Row]) -> dict[str, dict[str, str]]:
    """Return the groups that machines state; the newest record decides where they differ."""
    found: dict[str, dict[str, str]] = {"batch": {}, "type": {}}
    for row in records:
        for kind, column in (("batch", "batch"), ("type", "machine_name")):
            if row[column] is not None:
                found[kind][row["machine"]] = row[column]
    return found


def by_value(series: Sequence[Series]) -> Iterator[tuple[ValueName, list[Series]]]:
    """Yield every value with the series of all machines that have it."""
    found: dict[ValueName, list[Series]] = {}
    for each in series:
        found.setdefault(each.value_name, []).append(each)
    yield from sorted(found.items())
