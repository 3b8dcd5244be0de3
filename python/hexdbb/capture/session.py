"""One measurement from plan to record: plan, boot, enable, approach, run, retract, disable.

Nothing moves before the plan is known to be within reach, the bus load within budget, and every node configured and
read back. Whatever happens after that, all six axes stop together and what was captured becomes a record.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import can
import numpy as np
from numpy.typing import NDArray

from hexdbb.capture.boot import Devices, add_devices, boot, release
from hexdbb.capture.checks import Fault, Watch
from hexdbb.capture.cia402 import Command
from hexdbb.capture.clock import Clock
from hexdbb.capture.exchange import Exchange, Feedback
from hexdbb.capture.link import Link
from hexdbb.capture.loop import Loop
from hexdbb.capture.motion import Motion
from hexdbb.capture.request import Progress, Request
from hexdbb.capture.samples import Samples
from hexdbb.capture.setup import pauses, setup_changes
from hexdbb.capture.supervision import Supervision
from hexdbb.capture.transport import one_line
from hexdbb.errors import HexdbbError, RunError
from hexdbb.record import Journal, Record
from hexdbb.trajectory import Phase, Programme, approach

MAX_MISSED = 250
"""Cycles that may be missed in one run."""
LOCKSTEP_TOLERANCE_S = 1.0
"""What heartbeats may be later in lockstep, where nothing else depends on timing either."""


def measure(request: Request, programme: Programme, bus: can.BusABC, clock: Clock, progress: Progress) -> Record:
    """Run a programme on a bus and make its record.

    Parameters
    ----------
    request, programme : from `prepare`
    bus : an open bus; it stays open
    clock : pace of the loop
    progress : kept up to date for a display

    Returns
    -------
    Record

    Raises
    ------
    RunError
        The rig was refused, or a fault stopped the run; says what was kept.
    """
    progress.stage = "configuring nodes"
    link = Link(bus)
    devices = add_devices(link, request.machine)
    try:
        with link.threaded():
            progress.notes += boot(link, devices, request.machine, request.cycle_s)
        with link.looped():
            return _Run(request, programme, link, devices, clock, progress).record()
    except (can.CanError, OSError) as error:
        raise RunError(f"bus: {one_line(error)} (expected a working bus); nothing had moved") from error
    finally:
        _release(link, devices)


def _release(link: Link, devices: Devices) -> None:
    """Leave the nodes pre-operational, if the bus is still there."""
    try:
        release(link, tuple(devices))
    except (can.CanError, OSError):
        return


class _Run:
    """The part of a measurement in which axes move."""

    def __init__(
        self, request: Request, programme: Programme, link: Link, devices: Devices, clock: Clock, progress: Progress
    ) -> None:
        machine, cycle_s = request.machine, request.cycle_s
        can_setup = machine.can_setup
        self.request, self.programme, self.devices, self.progress = request, programme, devices, progress
        self.counts_per_mm = can_setup.counts_per_mm
        labels = tuple(device.label for device in devices)
        limit_s = can_setup.heartbeat_consumer_ms / 1000.0 + (0.0 if clock.real_time else LOCKSTEP_TOLERANCE_S)
        supervision = Supervision(
            labels, [device.node_id for device in devices], link.notify, limit_s, request.silent_after
        )
        exchange = Exchange(link.bus, can_setup.drive_nodes, can_setup.gauge_node, supervision.on_frame)
        self.loop = Loop(link, exchange, clock, can_setup.heartbeat_producer_ms / 1000.0)
        self.watch = Watch(
            feedback=exchange.feedback,
            supervision=supervision,
            labels=labels,
            window=round(can_setup.limits.following_error_mm * abs(self.counts_per_mm)),
            range_um=min(can_setup.limits.gauge_range_um, request.plan.gauge.range_um),
            counts_per_mm=self.counts_per_mm,
            max_stall=int(can_setup.rpdo_timeout_ms / 1000.0 / cycle_s),
            max_missed=MAX_MISSED,
            expected=self.loop.counts,
        )
        self.motion = Motion(self.loop, self.watch, labels, cycle_s)

    def record(self) -> Record:
        """Approach, run and keep; whatever goes wrong, stop all axes and keep what there is."""
        self.progress.stage = "asking where the axes stand"
        stand_mm = np.array(self.motion.stand()) / self.counts_per_mm
        self.motion.check_homed()
        programme, journal = self.loop.hold_while(lambda: self._made_ready(stand_mm), [Command.DISABLE_VOLTAGE] * 6)
        with journal:
            samples = Samples(programme, journal, self.counts_per_mm)
            cause = self._move(programme, samples)
            try:
                samples.flush()
                record = journal.finish(complete=cause is None, reason=cause)
            except RunError as error:
                known = cause is not None and str(error) in cause
                raise RunError(cause if known else "; ".join(filter(None, (cause, str(error))))) from None
        if cause is not None:
            raise RunError(f"{cause}; {samples.count} samples kept in {record.path}, marked incomplete")
        return record

    def _made_ready(self, stand_mm: NDArray[np.float64]) -> tuple[Programme, Journal]:
        """Compute the way from where the axes stand, and open the journal."""
        request, plan = self.request, self.request.plan
        way = approach(stand_mm, self.programme, request.machine, request.origin)
        journal = Journal(
            request.record,
            machine=request.machine,
            gauge=plan.gauge,
            mounts=plan.mounts,
            circles=plan.circles,
            metadata={**request.metadata, "notes": list(self.progress.notes)},
            overwrite=request.overwrite,
        )
        return self.programme.after(way), journal

    def _move(self, programme: Programme, samples: Samples) -> str | None:
        """Enable, follow, disable; returns the cause where a fault stopped it."""
        with _watching_interrupts(self.watch):
            try:
                self.progress.stage = "enabling"
                self.motion.enable()
                self._follow(programme, samples)
                self.progress.stage = "disabling"
                self.motion.disable()
            except (HexdbbError, can.CanError, OSError) as error:
                return self._stopped(error)
            except BaseException:
                # A mistake in the program must not leave axes enabled either.
                self.motion.stop()
                raise
        return None

    def _follow(self, programme: Programme, samples: Samples) -> None:
        table, progress = programme.table, self.progress
        progress.programme, progress.rows, progress.stage = programme, len(table), "moving"
        capture = table.capture.tolist()
        self.loop.restart_time()

        def keep(row: int, feedback: Feedback) -> None:
            progress.row, progress.slot, progress.reading_um = row, self.loop.slot, feedback.reading_um
            progress.missed = self.loop.missed
            if capture[row]:
                samples.keep(row, self.loop.slot, self.loop.last_missed, feedback)
                progress.samples = samples.count

        self.motion.follow(
            np.rint(table.sliders_mm * self.counts_per_mm).astype(np.int32),
            table.phase == Phase.ARC,
            keep,
            pauses(setup_changes(programme), self.request.plan.gauge, self.devices.gauge, self.request.confirm),
        )

    def _stopped(self, error: Exception) -> str:
        """Stop all axes and say why, when, and whether they all stand."""
        time_s = self.loop.slot * self.request.cycle_s
        self.progress.stage = "stopping all axes"
        if isinstance(error, HexdbbError):
            cause = str(error)
        else:
            cause = str(Fault("bus", f"{one_line(error)} (expected a working bus)"))
        unstopped = self.motion.stop()
        outcome = "; ".join(unstopped) if unstopped else "all six axes stopped"
        return f"{cause} at t = {time_s:.3f} s; {outcome}"


@contextmanager
def _watching_interrupts(watch: Watch) -> Iterator[None]:
    """Turn SIGINT and SIGTERM into a fault the next check finds, so that axes are stopped before the program ends."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def note(number: int, frame: object) -> None:
        watch.interrupted = True

    before: dict[signal.Signals, Callable[..., object] | int | None] = {
        number: signal.signal(number, note) for number in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
