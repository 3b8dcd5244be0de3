"""What ``hexdbb eds check --json`` prints."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, Literal

from hexdbb.capture.fitness import Fitness
from hexdbb.files.results import Count, JsonPart, JsonResult


@dataclass(frozen=True)
class FindingJson(JsonPart):
    """One object that is not as the test needs it."""

    object: str
    """Index and sub-index, hexadecimal: ``6040:00``."""
    level: Literal["cannot run", "runs without it", "to be set in the device"]
    """Whether the device can run the test all the same."""
    what: str
    """What is wrong, and what was expected."""
    consequence: str
    """What that means for the test."""
    line: Count | None
    """Line of the file that says so; null if none does."""


@dataclass(frozen=True)
class DeviceJson(JsonPart):
    """One file."""

    file: str
    """Path of the EDS or DCF."""
    device: Literal["drive", "gauge"]
    """What it was examined as."""
    usable: bool
    """Whether the device can run the test, as far as its EDS says."""
    findings: tuple[FindingJson, ...]
    """What it lacks; what refuses it first."""


@dataclass(frozen=True)
class EdsCheckJson(JsonResult):
    """Whether devices can run the circular test."""

    SCHEMA: ClassVar[str] = "hexdbb.eds/1"

    devices: tuple[DeviceJson, ...]
    """One for each file."""


def eds_check_json(examined: Mapping[Path, Fitness]) -> EdsCheckJson:
    """Return the result of `hexdbb eds check` as it is printed."""
    return EdsCheckJson(
        tuple(
            DeviceJson(
                str(path),
                fitness.device,
                fitness.usable,
                tuple(
                    FindingJson(each.place, each.level.value, each.what, each.consequence, each.line)
                    for each in fitness.findings
                ),
            )
            for path, fitness in examined.items()
        )
    )
