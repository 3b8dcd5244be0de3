"""Measurement file, the TOML beside a CSV: machine, gauge, mounts and circles that the samples refer to."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from hexdbb.files.validation import FileModel
from hexdbb.plan import Circles, Conditions, Gauge, Mounts, check_ids
from hexdbb.record.not_measured import NotMeasured


class Measurement(FileModel):
    """A validated measurement file; constructed and read under the file's own keys (`mount`, `circle`)."""

    schema_id: Literal["hexdbb.measurement/1"] = Field(default="hexdbb.measurement/1", alias="schema")
    """Kind and version of the file."""
    machine: Annotated[str, Field(min_length=1)]
    """Path of the machine file relative to this file, or the name of the shipped one, `sp120`."""
    complete: bool | None = None
    """False where the capture was interrupted; absent means complete."""
    plan: Annotated[str, Field(min_length=1)] | None = None
    """Name of the plan that was driven, for reports."""
    started: Annotated[str, Field(min_length=1)] | None = None
    """Date, or date and time, of the first sample, for reports."""
    conditions: Conditions | None = None
    """Conditions of the test, for reports."""
    not_measured: NotMeasured | None = None
    """What was computed instead of measured; absent where everything was measured."""
    gauge: Gauge
    """Ball bar and length gauge."""
    mounts: Mounts = Field(alias="mount")
    """Set-ups of the cup, one table each."""
    circles: Circles = Field(alias="circle")
    """Circles that the samples refer to, one table each."""

    @model_validator(mode="after")
    def _consistent(self) -> Measurement:
        check_ids(self.mounts, self.circles)
        return self
