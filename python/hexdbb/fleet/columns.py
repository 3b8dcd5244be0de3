"""The columns of a fleet's results: one row a record and value of an effect; plain types, by machine and month.

What is of the record stands in each of its rows. A record that could not be judged has one row, with the reason in
`error`; a discovery that found nothing has one row without an effect.
"""

from __future__ import annotations

import re

import pyarrow as pa

from hexdbb.cluster import Results
from hexdbb.trend.series import WATCHED_QUANTITIES

FLEET = "hexdbb.fleet.rows/1"
PARTITION = ("machine", "month")
UNKNOWN = "unknown"
"""Machine or month of a record that does not say."""

QUANTITIES = tuple(f"{key}_um" for key in WATCHED_QUANTITIES)
"""ISO 230-4 quantities of a record, the largest on any circle, feed and direction."""

COLUMNS = pa.schema(
    [
        ("machine", pa.string()),
        ("month", pa.string()),
        ("source", pa.string()),
        ("record", pa.string()),
        ("machine_name", pa.string()),
        ("serial_number", pa.string()),
        ("batch", pa.string()),
        ("measured_utc", pa.timestamp("us")),  # without a zone: readers differ in what they make of one
        ("plan", pa.string()),
        ("readings", pa.int64()),
        ("command", pa.string()),
        ("model", pa.string()),
        ("effect", pa.string()),
        ("element", pa.string()),
        ("name", pa.string()),
        ("value", pa.float64()),
        ("sigma", pa.float64()),
        ("unit", pa.string()),
        ("rms_before_um", pa.float64()),
        ("rms_after_um", pa.float64()),
        ("noise_um", pa.float64()),
        ("verdict", pa.string()),
        ("sentence", pa.string()),
        *((name, pa.float64()) for name in QUANTITIES),
        ("seconds", pa.float64()),
        ("hexdbb", pa.string()),
    ]
)


def fleet_results(url: str) -> Results:
    """Return the dataset of a fleet at a URL."""
    return Results(url, FLEET, COLUMNS, PARTITION)


def machine_key(name: str, serial_number: str | None) -> str:
    """Return what a machine is called in folders: name and serial number, in characters that every store takes.

    It begins with a letter: readers make a number of a folder's name that looks like one.
    """
    joined = name if serial_number is None else f"{name}-{serial_number}"
    plain = re.sub(r"[^A-Za-z0-9._]+", "-", joined).strip("-.") or UNKNOWN
    return plain if plain[0].isalpha() else f"machine-{plain}"
