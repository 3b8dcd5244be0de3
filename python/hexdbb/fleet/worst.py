"""Machines by their circular deviation, the worst first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

import numpy as np

from hexdbb.fleet.observed import Observed

NEWEST = 3
"""Records whose median ranks a machine: the newest alone may be one that was disturbed."""


@dataclass(frozen=True)
class MachineState:
    """How a machine stands.

    Attributes
    ----------
    machine, machine_name : str
    batch : str or None
    records : int
    newest : datetime or None
        Time of its newest record.
    deviation_um : float or None
        G(b), else G: the largest on any circle; median of the newest records.
    rms_after_um : float or None
        What its model leaves, median of the newest records.
    verdict : str or None
        Of the newest record.
    """

    machine: str
    machine_name: str
    batch: str | None
    records: int
    newest: datetime | None
    deviation_um: float | None
    rms_after_um: float | None
    verdict: str | None


def ranked_machines(observed: Observed) -> list[MachineState]:
    """Return all machines, those with the largest circular deviation first."""
    by_machine: dict[str, list[dict[str, Any]]] = {}
    for row in observed.records:
        by_machine.setdefault(row["machine"], []).append(row)
    states = [_state(machine, rows) for machine, rows in by_machine.items()]
    return sorted(states, key=lambda each: (-(each.deviation_um or 0.0), each.machine))


def _state(machine: str, rows: Sequence[dict[str, Any]]) -> MachineState:
    last, newest = rows[-1], rows[-NEWEST:]
    deviations = [row["bidirectional_circular_deviation_um"] or row["circular_deviation_um"] for row in newest]
    return MachineState(
        machine,
        last["machine_name"],
        last["batch"],
        len({row["record"] for row in rows}),
        last["measured_utc"],
        _median(deviations),
        _median([row["rms_after_um"] for row in newest]),
        last["verdict"],
    )


def _median(values: Sequence[float | None]) -> float | None:
    known = [each for each in values if each is not None]
    return float(np.median(known)) if known else None
