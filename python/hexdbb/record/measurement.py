"""The TOML beside a text-form record: the machine, the gauge, the mounts and the circles the samples refer to."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from hexdbb.files.validation import FileModel
from hexdbb.plan import Circles, Gauge, Mounts, check_ids


class Measurement(FileModel):
    """A measurement file, validated; constructed and read under the file's own keys (`mount`, `circle`)."""

    schema_id: Literal["hexdbb.measurement/1"] = Field(default="hexdbb.measurement/1", alias="schema")
    machine: Annotated[str, Field(min_length=1)]
    """Machine file relative to this one, or the name of the shipped one."""
    complete: bool | None = None
    """False where the capture was interrupted; not set means complete."""
    gauge: Gauge
    mounts: Mounts = Field(alias="mount")
    circles: Circles = Field(alias="circle")

    @model_validator(mode="after")
    def _consistent(self) -> Measurement:
        check_ids(self.mounts, self.circles)
        return self
