"""Limits that the trend of a machine's records is watched by."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from hexdbb.files.validation import BadValueError, Positive, StrictModel


class Watch(StrictModel):
    """One limit: of an ISO 230-4 quantity or of an effect; `hexdbb trend` ends with a status of its own beyond it."""

    what: Annotated[str, Field(min_length=1)]
    """`G`, `G(b)` or `H`, the largest on any circle; or an effect, `backlash`, or one element, `leg_length:2`."""
    limit: Positive
    """Largest magnitude that is allowed; an effect is beyond it where it is so with its interval."""
    alarm: Positive | None = None
    """Magnitude from which it is an alarm, above `limit`."""
    unit: Annotated[str, Field(min_length=1)]
    """Unit of both, as `hexdbb trend` shows it, in ASCII: `um`, `urad`, `ms`."""
    parameter: Annotated[str, Field(min_length=1)] | None = None
    """Which parameter of the effect is meant, where it has several, as `x` of `guideway_translation`."""
    change: bool = False
    """Whether the change since the first record is meant instead of the value."""

    @model_validator(mode="after")
    def _alarm_above_limit(self) -> Watch:
        if self.alarm is not None and self.alarm <= self.limit:
            raise BadValueError(("alarm",), self.alarm, f"more than limit, {self.limit:g}")
        return self
