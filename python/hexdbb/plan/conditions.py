"""Conditions of a test that no reading shows: who tested, at which temperature, and what else should be remembered.

All optional, and no part of what a fit uses: a record with other notes is the same record.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from hexdbb.files.validation import Number, StrictModel

Words = Annotated[str, Field(min_length=1)]


class Conditions(StrictModel):
    """Conditions of a test."""

    operator: Words | None = None
    """Who tests."""
    notes: Words | None = None
    """What should be remembered of the test."""
    temperature_c: Number | None = None
    """Temperature of the machine, where no thermometer is read with the samples."""
