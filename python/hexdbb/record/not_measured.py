"""What a record holds that was not measured but computed, and from what: slider coordinates, times.

Ball-bar programs export angle and deviation only. hexdbb then computes slider coordinates from the commanded circle and
times from the commanded feed; the record says so in its metadata (`KEY`), its text form in a table of the same name,
and every analysis leaves out what only measured values could decide.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import Field, ValidationError

from hexdbb.files.validation import StrictModel

KEY = "not_measured"
"""Key of the metadata, and table of the text form's TOML."""
Origin = Annotated[str, Field(min_length=1)]


class NotMeasured(StrictModel):
    """What was computed instead of measured."""

    sliders: Origin | None = None
    """Origin of slider coordinates that no encoder has given; following errors of the drives are not in them."""
    time: Origin | None = None
    """Origin of times that no clock has given; drift and warming cannot be judged by them."""

    def __bool__(self) -> bool:
        return self != NotMeasured()


def not_measured_in(metadata: Mapping[str, Any]) -> NotMeasured:
    """Return what a record's metadata state as computed; nothing where they are of another program's form."""
    try:
        return NotMeasured.model_validate(metadata.get(KEY) or {})
    except ValidationError:
        return NotMeasured()


def not_measured_metadata(stated: NotMeasured | None) -> dict[str, object]:
    """Return the metadata that state what was computed; none where everything was measured."""
    return {KEY: stated.model_dump(exclude_none=True)} if stated else {}
