"""Mounts: the set-ups of the cup on the base."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from hexdbb.files.validation import StrictModel, Vector3

Identity = Annotated[int, Field(ge=0, le=2**31 - 1)]
"""Number that samples and circles use to refer to a circle or a mount; a record holds it as int32."""


FixingName = Annotated[str, Field(min_length=1, max_length=80, pattern=r"^[^\x00-\x1f]*$")]
"""Name of one fixing of the cup, on one line."""


class Mount(StrictModel):
    """One fixing of the cup on the base; its true position is an unknown of the fit."""

    id: Identity
    """Number of the mount, unique in its file."""
    cup_mm: Vector3
    """Nominal centre of the cup (x, y, z), base frame."""
    fixing: FixingName | None = None
    """Name that the mounts of several records share where the cup was not touched between them: one position for all.
    Absent: a fixing of its record alone."""
