"""Conditions of a test in a record's metadata, and in the text form's TOML.

Metadata keys: `conditions` (a dict of `hexdbb.plan.Conditions`), `started`, `plan`, `not_measured`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

from hexdbb.plan import Conditions
from hexdbb.record.measurement import Measurement
from hexdbb.record.not_measured import KEY as NOT_MEASURED
from hexdbb.record.not_measured import not_measured_in, not_measured_metadata

KEY = "conditions"
DESCRIBED = ("plan", "started")
"""Texts of the metadata that the text form keeps beside the conditions."""


def conditions_in(metadata: Mapping[str, Any]) -> Conditions:
    """Return the conditions that a record's metadata state; other programs may have put there what is none."""
    found = metadata.get(KEY)
    known = {}
    for name in Conditions.model_fields:
        value = found.get(name) if isinstance(found, Mapping) else None
        try:
            Conditions.model_validate({name: value})
        except ValidationError:
            continue
        known[name] = value
    return Conditions.model_validate(known)


def conditions_metadata(*conditions: Conditions | None) -> dict[str, object]:
    """Return the metadata of conditions, the later ones before the earlier ones; none where there are none."""
    stated: dict[str, object] = {}
    for each in conditions:
        stated |= {} if each is None else each.model_dump(exclude_none=True)
    return {KEY: stated} if stated else {}


def described_metadata(measurement: Measurement) -> dict[str, Any]:
    """Return what a measurement file says of a test, as metadata of its record."""
    texts = {name: getattr(measurement, name) for name in DESCRIBED if getattr(measurement, name) is not None}
    computed = not_measured_metadata(measurement.not_measured)
    return {**texts, **conditions_metadata(measurement.conditions), **computed}


def with_description(measurement: Measurement, metadata: Mapping[str, Any]) -> Measurement:
    """Return a measurement file with what a record's metadata say of the test."""
    texts = {name: metadata[name] for name in DESCRIBED if isinstance(metadata.get(name), str) and metadata[name]}
    stated = conditions_in(metadata)
    conditions = stated if stated != Conditions() else None
    computed = not_measured_in(metadata) or None
    return measurement.model_copy(update={**texts, KEY: conditions, NOT_MEASURED: computed})
