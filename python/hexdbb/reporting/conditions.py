"""Under which conditions a record was measured, as rows of a report."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime
from typing import Any

import numpy as np

from hexdbb import __version__
from hexdbb.comparison.circles import compensation_of
from hexdbb.record import Record
from hexdbb.samples.unmeasured import not_measured_sentences

NOT_RECORDED = "not recorded"


def condition_rows(record: Record) -> list[tuple[str, str]]:
    """Return name and value of everything that a reader of the report must know of a record, in a fixed order."""
    said = record.conditions
    rows = [
        ("record", record.name + ("" if record.complete else " (incomplete: the capture was interrupted)")),
        ("machine", record.machine.name),
        ("serial number of the machine", record.machine.serial_number),
        ("operator", said.operator),
        ("date", _date(record.metadata.get("started"))),
        ("plan", _text(record.metadata.get("plan"))),
        ("circles and feeds", _driven(record)),
        ("driven with compensation", compensation_of(record) or "none"),
        ("not measured", "; ".join(not_measured_sentences([record])) or "nothing: encoders and clock were read"),
        ("ball bar", _bar(record)),
        ("serial number of the bar", record.gauge.serial_number),
        ("calibrated", None if record.gauge.calibrated is None else record.gauge.calibrated.isoformat()),
        ("temperature", _temperature(record)),
        ("notes", said.notes),
        ("software", _software(record)),
        ("hash of the record", record.content_hash()),
    ]
    return [(name, value or NOT_RECORDED) for name, value in rows]


def _text(value: Any) -> str | None:
    return str(value) if value not in (None, "") else None


def _date(value: Any) -> str | None:
    """Return a time as ISO 8601 has it for readers; what is no time as it is."""
    try:
        return datetime.fromisoformat(str(value)).strftime("%Y-%m-%d %H:%M %Z").strip()
    except ValueError:
        return _text(value)


def _software(record: Record) -> str:
    return f"measured by {_text(record.metadata.get('software')) or 'another program'}; report by hexdbb {__version__}"


def _driven(record: Record) -> str:
    feeds = ", ".join(f"{feed:g}" for feed in np.unique(record.columns["feed_mm_min"]))
    circles = _counted(len(np.unique(record.columns["circle"])), "circle")
    sweeps = _counted(len(record.sweeps()), "sweep")
    return f"{circles} at {feeds} mm/min, {sweeps}, {_counted(len(record), 'reading')}"


def _counted(number: int, word: str) -> str:
    return f"{number:,} {word}{'' if number == 1 else 's'}"


def _bar(record: Record) -> str:
    gauge = record.gauge
    noise = "" if gauge.noise_um is None else f", noise {gauge.noise_um:g} µm"
    return f"{gauge.bar_length_mm:g} mm, resolution {gauge.resolution_um:g} µm{noise}"


def _temperature(record: Record) -> str | None:
    parts = list(_temperatures(record))
    return ", ".join(parts) or None


def _temperatures(record: Record) -> Iterator[str]:
    if record.conditions.temperature_c is not None:
        yield f"{record.conditions.temperature_c:g} °C"
    read = record.columns.get("temperature_c", np.zeros(0))
    if np.isfinite(read).any():
        yield f"{np.nanmin(read):.1f} to {np.nanmax(read):.1f} °C read with the samples"
