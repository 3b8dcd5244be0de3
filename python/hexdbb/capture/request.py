"""The request for a measurement, its checks that need no bus, and the progress of the run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from hexdbb.capture.bus_load import check_load
from hexdbb.capture.cycle_times import CycleTimes
from hexdbb.capture.settings import check_counts, interpolation_period
from hexdbb.capture.setup import Confirm
from hexdbb.capture.supervision import SILENT_AFTER
from hexdbb.capture.watch import Watch
from hexdbb.machine import MachineFile
from hexdbb.plan import Plan
from hexdbb.record.columns import Columns
from hexdbb.trajectory import Phase, Programme, Targets, plan_programme


@dataclass
class RunProgress:
    """Progress of a run; written by the loop, read by a display.

    Attributes
    ----------
    stage : str
        Present phase of the run: ``reading axis positions``, ``enabling``, ``moving`` ...
    row, rows : int
        Present row and number of rows of the targets.
    place : tuple of int
        Phase (`hexdbb.trajectory.Phase`) of the present row, and index of its run, -1 for none.
    cycle_index : int
        Time of motion in cycles.
    paused : bool
        Whether the operator is being asked to do something.
    samples : int
        Samples captured so far.
    missed : int
        Cycles missed so far.
    reading_um : float
        Last reading, µm; nan before the first one.
    programme : Programme or None
        The targets that are being followed, approach included.
    notes : list of str
        Objects that devices lack and requests that the system refused, with the consequences.
    watch : Watch or None
        What the checks examine, once nodes are configured.
    times : CycleTimes or None
        Histograms of the cycles, from then on.
    written : callable or None
        Takes the columns of every batch of samples, in the journal's thread, when they are on disk; returns at once
        and does not raise.
    """

    stage: str = "starting"
    row: int = 0
    rows: int = 0
    place: tuple[int, int] = (int(Phase.APPROACH), -1)
    cycle_index: int = 0
    paused: bool = False
    samples: int = 0
    missed: int = 0
    reading_um: float = float("nan")
    programme: Programme | None = None
    notes: list[str] = field(default_factory=list)
    watch: Watch | None = None
    times: CycleTimes | None = None
    written: Callable[[Columns], None] | None = None


@dataclass(frozen=True)
class Request:
    """A plan to be measured and the record to be written.

    Attributes
    ----------
    plan : Plan
        Circles, feeds and set-ups.
    machine : MachineFile
        The machine that the plan names.
    origin : str
        Name of the plan in errors.
    cycle_s : float
        SYNC period, s.
    record : Path
        The Parquet record to be written.
    overwrite : bool
        Whether an existing record may be replaced.
    confirm : callable or None
        Asks the operator to mount the bar and returns when it is done; None if nobody is to be asked.
    silent_after : int
        Consecutive unanswered SYNCs of a node after which all axes stop.
    metadata : dict
        Further metadata of the record.
    targets : Targets or None
        Source of the sliders' targets; None for the nominal machine.
    nodes_here : bool
        Whether the nodes are simulated on this computer: where it is busy, they answer late.
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
    nodes_here: bool = False


def prepare(request: Request) -> Programme:
    """Compute all targets and check everything that needs no bus: reach, limits, bus load, cycle time.

    Parameters
    ----------
    request : Request

    Returns
    -------
    Programme
        Targets of every cycle, without the approach from the present position.

    Raises
    ------
    InputError
        The plan cannot be driven or the cycle rate cannot be used; names place or value and limit.
    """
    can_setup = request.machine.can_setup
    check_load(1.0 / request.cycle_s, can_setup.bitrate_bit_s, len(can_setup.drive_nodes))
    interpolation_period(request.cycle_s)
    check_counts(request.machine)
    return plan_programme(request.plan, request.machine, request.cycle_s, request.origin, request.targets)
