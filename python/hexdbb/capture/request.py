"""What is to be measured, what can be checked of it without a bus, and how far the measurement has come."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from hexdbb.capture.bus_load import check_load
from hexdbb.capture.settings import check_counts, interpolation_period
from hexdbb.capture.setup import Confirm
from hexdbb.capture.supervision import SILENT_AFTER
from hexdbb.machine import MachineFile
from hexdbb.plan import Plan
from hexdbb.trajectory import Programme, Targets, plan_programme


@dataclass
class Progress:
    """What a display may show; written by the loop, read by others.

    Attributes
    ----------
    stage : what is being done, in words
    row, rows : place in the table of targets
    slot, samples, missed, reading_um : as the loop has them
    paused : whether the operator is being asked something
    notes : what devices or the system lack, and what that means
    """

    stage: str = "starting"
    row: int = 0
    rows: int = 0
    slot: int = 0
    paused: bool = False
    samples: int = 0
    missed: int = 0
    reading_um: float = float("nan")
    programme: Programme | None = None
    notes: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Request:
    """What to measure and where to keep it.

    Attributes
    ----------
    plan, machine : the plan and the machine it names
    origin : names the plan in errors
    record : path of the record to be made
    overwrite : whether an existing record may be replaced
    confirm : asks the operator to mount the bar; None where nobody has to
    silent_after : SYNCs in a row a node may leave unanswered before all axes stop
    metadata : what else to keep in the record
    targets : what gives the sliders' targets; the nominal machine's where None
    """

    plan: Plan
    machine: MachineFile
    origin: str
    cycle_s: float
    record: Path
    overwrite: bool = False
    confirm: Confirm | None = None
    silent_after: int = SILENT_AFTER
    metadata: dict[str, object] = field(default_factory=dict)
    targets: Targets | None = None


def prepare(request: Request) -> Programme:
    """Do all that can be done without a bus: reach and limits of the plan, bus load.

    Raises
    ------
    InputError
        The plan or the cycle rate cannot be run.
    """
    can_setup = request.machine.can_setup
    check_load(1.0 / request.cycle_s, can_setup.bitrate_bit_s, len(can_setup.drive_nodes))
    interpolation_period(request.cycle_s)
    check_counts(request.machine)
    return plan_programme(request.plan, request.machine, request.cycle_s, request.origin, request.targets)
