"""One measurement, from a plan to its record.

Phases: configuring nodes, reading axis positions, homing check, enabling, approach, capture of each run, return,
disabling. Nothing moves before the plan is known to be within reach, the bus load within its limit, and every node
configured and read back. Whatever fails after that, all six axes stop together and the captured samples become a
record.
"""

from __future__ import annotations

import logging

import can
import numpy as np
from numpy.typing import NDArray

from hexdbb.capture.blame import NODES_HERE
from hexdbb.capture.boot import Devices, add_devices, boot, refuse_unfit, release
from hexdbb.capture.captured_rows import CapturedRows
from hexdbb.capture.checks import MAX_REPEATED
from hexdbb.capture.cia402 import Command
from hexdbb.capture.clock import Clock
from hexdbb.capture.exchange import Exchange
from hexdbb.capture.interrupts import Interrupts
from hexdbb.capture.latency import shown_ms
from hexdbb.capture.lateness import LOCKSTEP_PERIOD_S, NOTED_S, PERIOD_S, Lateness
from hexdbb.capture.link import Link
from hexdbb.capture.loop import Loop
from hexdbb.capture.motion import VERIFY_SYNCS, AxisGroup, MotionFaultError
from hexdbb.capture.real_time_check import advice, judged, words
from hexdbb.capture.request import Request, RunProgress
from hexdbb.capture.sample_buffer import SampleBuffer
from hexdbb.capture.setup import pauses, setup_changes
from hexdbb.capture.supervision import Supervision
from hexdbb.capture.targets_ahead import TargetsAhead
from hexdbb.capture.transport import one_line
from hexdbb.capture.watch import Fault, watch_over
from hexdbb.errors import HexdbbError, RunError
from hexdbb.record import Journal, Record
from hexdbb.trajectory import Programme, approach

log = logging.getLogger(__name__)

MAX_LOST = 0.01
"""Largest share of the planned samples that a complete record may lack: four degrees of a circle; what is lost more
leaves gaps in the fit, and has a cause that should be known."""
LOOK_S = 2.0
"""Time for which real time is tried before anything moves, s: 500 cycles at 250 Hz, in which a delay that happens once
in a hundred cycles shows with certainty, and which no operator minds."""
LOCKSTEP_TOLERANCE_S = 1.0
"""Added to the heartbeat limit in lockstep, s. Nothing else depends on time there, and a busy desktop may stall the
process that sends the heartbeats."""


def measure(
    request: Request,
    programme: Programme,
    bus: can.BusABC,
    clock: Clock,
    progress: RunProgress | None = None,
    interrupts: Interrupts | None = None,
) -> Record:
    """Drive a programme on a bus and write its record.

    Parameters
    ----------
    request : Request
        The plan and the record to be written.
    programme : Programme
        Its targets, from `prepare`.
    bus : can.BusABC
        An open bus; it stays open.
    clock : Clock
        Pace of the loop: `Lockstep` or `Deadlines`.
    progress : RunProgress, optional
        Updated during the run for a display.
    interrupts : Interrupts, optional
        Signals that end the run; by default those that arrive during this call.

    Returns
    -------
    Record
        The record as written: complete, with the path `request.record`.

    Raises
    ------
    InputError
        An EDS cannot be read, the approach is out of reach, or the record exists.
    RunError
        The rig was refused before motion, or a fault stopped the run; names the cause and what was kept.
    """
    progress = RunProgress() if progress is None else progress
    interrupts = Interrupts() if interrupts is None else interrupts
    progress.stage = "configuring nodes"
    link = Link(bus)
    devices = add_devices(link, request.machine)
    refuse_unfit(devices, request.machine, request.cycle_s)
    try:
        with interrupts.watched():
            with link.threaded():
                notes, sync_overflow = boot(link, devices, request.machine, request.cycle_s, clock.real_time)
                progress.notes += notes
            computer = Lateness(period_s=PERIOD_S if clock.real_time else LOCKSTEP_PERIOD_S)
            with link.looped(), computer.measured():
                run = _Run(request, programme, link, devices, clock, progress, interrupts, computer, sync_overflow)
                return run.record()
    except (can.CanError, OSError) as error:
        raise RunError(f"bus: {one_line(error)} (expected a working bus); nothing has moved") from error
    finally:
        progress.notes += link.notes()
        _release(link, devices)


def _release(link: Link, devices: Devices) -> None:
    """Return the nodes to pre-operational, if the bus still works."""
    try:
        release(link, tuple(devices))
    except (can.CanError, OSError):
        return


class _Run:
    """The part of a measurement in which axes move."""

    def __init__(
        self,
        request: Request,
        programme: Programme,
        link: Link,
        devices: Devices,
        clock: Clock,
        progress: RunProgress,
        interrupts: Interrupts,
        computer: Lateness,
        sync_overflow: int,
    ) -> None:
        machine, cycle_s = request.machine, request.cycle_s
        can_setup = machine.can_setup
        self.request, self.programme, self.devices, self.progress = request, programme, devices, progress
        self.link = link
        self.counts_per_mm = can_setup.counts_per_mm
        labels = tuple(device.label for device in devices)
        limit_s = can_setup.heartbeat_consumer_ms / 1000.0 + (0.0 if clock.real_time else LOCKSTEP_TOLERANCE_S)
        supervision = Supervision([device.node_id for device in devices], link.notify, limit_s, request.silent_after)
        exchange = Exchange(link.bus, can_setup.drive_nodes, can_setup.gauge_node, supervision.on_frame, sync_overflow)
        self.loop = Loop(link, exchange, clock, can_setup.heartbeat_producer_ms / 1000.0, cycle_s)
        self.watch = watch_over(
            exchange,
            supervision,
            labels,
            machine,
            request.plan.gauge,
            cycle_s=cycle_s,
            ball_mm_s=max(run.feed_mm_min for run in programme.runs) / 60.0,
            expected=self.loop.counts,
            real_time=clock.real_time,
            interrupts=interrupts,
            computer=computer,
        )
        self.watch.nodes_here = request.nodes_here
        self.axes = AxisGroup(self.loop, self.watch, labels, cycle_s)
        progress.watch, progress.times = self.watch, self.loop.times

    def record(self) -> Record:
        """Drive and record; whatever fails, stop all axes and keep the captured samples."""
        self.progress.stage = "reading axis positions"
        present_mm = np.array(self.axes.read_positions()) / self.counts_per_mm
        self.axes.check_homed()
        if self.loop.clock.real_time:
            self._look()
        self.watch.interrupts.note_only()
        programme, targets, journal = self.loop.hold_while(
            lambda: self._with_approach(present_mm), [Command.DISABLE_VOLTAGE] * 6
        )
        with targets, journal:
            samples = SampleBuffer(programme, journal, self.counts_per_mm)
            cause = self._move(programme, samples, targets) or self._too_few(samples, programme)
            try:
                samples.flush()
                known: dict[str, object] = {"notes": [*self.progress.notes, *self.link.notes()]}
                if self.loop.clock.real_time:
                    known["latency"] = self.loop.times.latency.metadata()
                record = journal.finish(cause is None, cause, samples.until_s, known)
            except RunError as error:
                if cause is not None and str(error) in cause:
                    raise RunError(cause) from None
                raise RunError("; ".join(filter(None, (cause, str(error))))) from None
        if cause is not None:
            raise RunError(f"{cause}; {len(record)} samples kept in {record.path}, marked incomplete")
        return record

    def _look(self) -> None:
        """Try real time with the drives disabled, and note whether the rate is safe and what to change."""
        self.progress.stage = "measuring how late this computer is"
        latency, cycle_s = self.loop.times.latency, self.request.cycle_s
        latency.clear()
        self.axes.wait(round(LOOK_S / cycle_s))
        verdict = judged(latency, 1.0 / cycle_s, self.request.machine.can_setup.rpdo_timeout_ms / 1000.0)
        note = words(latency, verdict)
        if not verdict.safe:
            refused = [each for each in self.progress.notes if "not granted" in each]
            note += f". To change: {'; '.join(advice(refused))}. A longer look: hexdbb check-realtime"
        self.progress.notes.append(note)

    def _with_approach(self, present_mm: NDArray[np.float64]) -> tuple[Programme, TargetsAhead, Journal]:
        """Compute the approach from the present positions, read the first targets, and open the journal."""
        request, plan = self.request, self.request.plan
        programme = self.programme.after(approach(present_mm, self.programme, request.machine, request.origin))
        targets = TargetsAhead(programme.part, len(programme), self.counts_per_mm)
        journal = Journal(
            request.record,
            machine=request.machine,
            gauge=plan.gauge,
            mounts=plan.mounts,
            circles=plan.circles,
            metadata={**request.metadata, "notes": list(self.progress.notes)},
            overwrite=request.overwrite,
            written=self.progress.written,
            may_wait=not self.loop.clock.real_time,
        )
        if journal.set_aside is not None:
            kept = f"recover it with: hexdbb recover {journal.set_aside} -o RECORD"
            self.progress.notes.append(f"journal of an interrupted capture kept as {journal.set_aside}; {kept}")
        targets.begin()
        return programme, targets, journal

    def _move(self, programme: Programme, samples: SampleBuffer, targets: TargetsAhead) -> str | None:
        """Enable, follow the targets, disable; return the cause if a fault stopped the run."""
        try:
            self.axes.check_interrupts()
            self.progress.stage = "enabling"
            self.axes.enable()
            self._follow(programme, samples, targets)
            self.progress.stage = "disabling"
            self.axes.disable()
        except Exception as error:  # an error in this program must neither leave axes enabled nor lose the record
            return self._stopped(error, samples)
        except BaseException:
            self.axes.stop()
            raise
        return None

    def _follow(self, programme: Programme, samples: SampleBuffer, targets: TargetsAhead) -> None:
        progress = self.progress
        progress.programme, progress.rows, progress.stage = programme, len(programme), "moving"
        self.loop.restart_time()
        self.axes.follow(
            targets,
            CapturedRows(samples, self.loop, progress),
            pauses(setup_changes(programme), self.request.plan.gauge, self.devices.gauge, self.request.confirm),
            # The answers too many that a run survives cost no more samples than a record may lack.
            max(VERIFY_SYNCS, int(MAX_LOST * int(programme.captured.sum()) / MAX_REPEATED)),
        )

    def _stopped(self, error: Exception, samples: SampleBuffer) -> str:
        """Stop all axes and drop what is doubtful; return cause, time and whether all of them stopped."""
        cycle_index = self.loop.cycle_index
        time_s = cycle_index * self.request.cycle_s
        self.progress.stage = "stopping all axes"
        if isinstance(error, HexdbbError):
            cause = str(error)
        elif isinstance(error, can.CanError | OSError):
            cause = str(Fault("bus", f"{one_line(error)} (expected a working bus)"))
        else:
            log.debug("an error in this program stopped the run", exc_info=error)
            cause = str(Fault("controller", f"{type(error).__name__}: {one_line(error)} (an error in this program)"))
        unstopped = self.axes.stop()
        try:
            paired = self.loop.confirm()
        except (can.CanError, OSError):
            paired = False  # nobody can tell any more
        # Whatever stopped the run: readings that had begun to repeat may be those of a gauge that is stuck.
        doubtful = self.watch.plausibility.same_cycles
        if isinstance(error, MotionFaultError):
            doubtful = max(doubtful, error.fault.doubtful)
        if doubtful:
            samples.cut(cycle_index - doubtful)
        if paired:
            samples.confirm()
        else:
            samples.drop()
        outcome = "; ".join(unstopped) if unstopped else "all six axes stopped"
        return f"{cause} at t = {time_s:.3f} s; {outcome}"

    def _too_few(self, samples: SampleBuffer, programme: Programme) -> str | None:
        """Return what is missing of a run that came to its end, if it is more than a record may lack."""
        planned = int(programme.captured.sum())
        lost = planned - samples.count
        # One lost answer is no reason to call a record incomplete, however short it is.
        allowed = max(int(MAX_LOST * planned), self.loop.cost_of_a_lost_answer)
        if lost <= allowed:
            return None
        (repeated, slot), labels = self.loop.repeated, self.watch.labels
        causes = [] if slot is None else [f"{labels[slot]}: {repeated} answers too many"]
        causes += self.watch.supervision.late_answers(labels)
        if self.loop.missed:
            causes.append(f"SYNCs not sent because they were late or answers were waited for: {self.loop.missed}")
        if self.loop.clock.real_time:
            causes.append(f"this computer was at most {shown_ms(max(self.watch.computer.worst_s, NOTED_S))} late")
            causes += [NODES_HERE] if self.watch.nodes_here else []
        why = f"{', '.join(causes)}: " if causes else ""
        return (
            f"{why}{lost} of {planned} planned samples are missing, {samples.dropped} of them not certainly paired "
            f"with their SYNC (expected at most {allowed})"
        )
