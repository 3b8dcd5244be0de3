"""The six axes together: read positions, enable without a jump, follow a table, stop, disable.

Assumption users get wrong: a command that was sent is not a command that was obeyed. A drive counts as enabled, stopped
or in a mode only when its statusword, mode display and position show it.
Source: CiA 402-2, state machine (controlword 6040h, statusword 6041h) and cyclic synchronous position mode.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import chain
from typing import Protocol

from hexdbb.capture.blame import blamed_before_motion
from hexdbb.capture.checks import find_fault
from hexdbb.capture.cia402 import (
    CYCLIC_SYNCHRONOUS_POSITION,
    ENABLE_SEQUENCE,
    HOMED,
    Command,
    DriveState,
    state_of,
)
from hexdbb.capture.exchange import Feedback
from hexdbb.capture.loop import Loop, nothing
from hexdbb.capture.standstill import Standstill
from hexdbb.capture.targets_ahead import Row
from hexdbb.capture.transport import one_line
from hexdbb.capture.watch import Fault, Watch
from hexdbb.errors import RunError

STEP_TIMEOUT_S = 2.0
"""Longest time for one transition of all drives, s, counted in cycles. Switching power on and releasing a brake takes
some tenths of a second; a drive that needs more than 2 s has failed."""
STOP_TIMEOUT_S = 2.0
"""Longest time from quick stop to standstill, s, counted in cycles: from the shipped velocity limit (250 mm/s) a ramp
of 125 mm/s² would suffice, a twentieth of the acceleration limit. Wall-clock time may be twice as long."""
STOPPED_STATES = (
    DriveState.QUICK_STOP_ACTIVE,
    DriveState.SWITCH_ON_DISABLED,
    DriveState.FAULT,
    DriveState.READY_TO_SWITCH_ON,
)

VERIFY_SYNCS = 25
"""Fewest SYNCs in lockstep between two looks for answers too many: 1 ms of silence each, a quarter of the time that so
many cycles take. What is not verified is dropped if there is one: of a circle of 2,500 samples one in a hundred."""
VERIFY_S = 0.1
"""Longest time between two such looks, s, where the computer is so busy that these SYNCs take longer: samples that are
not verified are not on disk, and would be lost if the controller were killed."""


class Rows(Protocol):
    """Receives the answers that belong to the rows of a table."""

    def keep(self, row: Row, feedback: Feedback) -> None:
        """Take the answers of a row; they are not certain yet."""

    def settle(self, paired: bool, held: int) -> None:
        """Accept all but the last `held` rows taken, or drop all not accepted yet if not `paired`."""

    def pause(self) -> None:
        """Let nothing that was accepted wait for more: none comes for a while."""


class MotionFaultError(RunError):
    """A fault was found while axes were enabled.

    Attributes
    ----------
    fault : Fault
        The cause.
    """

    def __init__(self, fault: Fault) -> None:
        super().__init__(str(fault))
        self.fault = fault


class AxisGroup:
    """The six axes, commanded together.

    Parameters
    ----------
    loop : Loop
        Runs the cycles.
    watch : Watch
        Quantities that the checks examine.
    labels : sequence of str
        Names of the drives and the gauge in messages.
    cycle_s : float
        SYNC period, s.
    """

    def __init__(self, loop: Loop, watch: Watch, labels: Sequence[str], cycle_s: float) -> None:
        self._loop, self._watch, self._labels, self._cycle_s = loop, watch, labels, cycle_s

    def read_positions(self) -> list[int]:
        """Read the positions of the axes with the drives disabled, after a fault reset.

        Returns
        -------
        list of int
            Object 6064h of each drive, counts, shape (6,).

        Raises
        ------
        RunError
            A node does not answer, shows another mode, or has a fault that the reset does not clear.
        """
        for command in (Command.DISABLE_VOLTAGE, Command.FAULT_RESET, Command.DISABLE_VOLTAGE):
            feedback = self._until(command, lambda feedback: not feedback.missing, "an answer to SYNC")
        self._until(Command.DISABLE_VOLTAGE, self._all_in(DriveState.SWITCH_ON_DISABLED), "switch on disabled")
        self._watch.supervision.forget_earlier()
        in_mode = [mode == CYCLIC_SYNCHRONOUS_POSITION for mode in feedback.mode]
        if not all(in_mode):
            slot = in_mode.index(False)
            raise RunError(
                f"{self._labels[slot]}: object 6061:00 is {feedback.mode[slot]} "
                f"(expected {CYCLIC_SYNCHRONOUS_POSITION}, as commanded in 6060:00)"
            )
        return list(feedback.position)

    def wait(self, cycles: int) -> None:
        """Run cycles with the drives disabled; nothing is checked."""
        for _ in range(cycles):
            self._loop.cycle([Command.DISABLE_VOLTAGE] * 6, list(self._loop.feedback.position))

    def check_homed(self) -> None:
        """Check that every drive reports a homed position (statusword bit 15); raises `RunError` otherwise."""
        for label, word in zip(self._labels, self._loop.feedback.statusword, strict=False):
            if not word & HOMED:
                raise RunError(f"{label}: object 6041:00 is {word:04X}h, not homed (expected bit 15)")

    def check_interrupts(self) -> None:
        """Check that no signal has asked the program to end; raises `MotionFaultError` otherwise."""
        requested = self._watch.interrupts.requested
        if requested is not None:
            raise MotionFaultError(Fault("hexdbb-run", requested))

    def enable(self) -> list[int]:
        """Enable operation without a jump: each target is the present position of its axis.

        Returns
        -------
        list of int
            The targets, counts, shape (6,).

        Raises
        ------
        RunError
            A drive does not reach the next state; the caller must stop all axes.
        """
        for command, state in ENABLE_SEQUENCE:
            if state is DriveState.OPERATION_ENABLED:
                # Constant from here on: a target that kept following the position would let the axis drift.
                self._loop.counts = list(self._loop.feedback.position)
            self._until(command, self._all_in(state), state.label, follow=state is not DriveState.OPERATION_ENABLED)
        return list(self._loop.counts)

    def follow(
        self,
        rows: Iterable[Row],
        kept: Rows,
        pauses: Mapping[int, Callable[[], None]],
        verify_syncs: int = VERIFY_SYNCS,
    ) -> None:
        """Send targets, one row per cycle, and check every answer.

        Parameters
        ----------
        rows : iterable of Row
            Targets in order; the reading must be valid and within range in those on a circle.
        kept : Rows
            Takes the answers that belong to each row.
        pauses : mapping of int to callable
            Work to be done before a row is sent, while the targets are held.
        verify_syncs : int
            SYNCs in lockstep between two looks for answers too many, after which what was kept is settled.

        Raises
        ------
        MotionFaultError
            A check found a fault; the targets remain those sent last.
        can.CanError
            The bus is lost.
        """
        loop = self._loop
        # A heartbeat sent before the nodes were started may have arrived only now.
        self._watch.supervision.forget_stale_states()
        # A long wait for answers must not keep samples from the disk that are certain already.
        loop.while_waiting = lambda: kept.settle(loop.confirm(), held=0)
        try:
            self._follow(rows, kept, pauses, verify_syncs)
        finally:
            loop.while_waiting = nothing
        kept.settle(loop.confirm(), held=0)

    def _follow(
        self, rows: Iterable[Row], kept: Rows, pauses: Mapping[int, Callable[[], None]], verify_syncs: int
    ) -> None:
        watch, loop, enabled = self._watch, self._loop, [Command.ENABLE_OPERATION] * 6
        sent: Row | None = None
        verified_s = time.monotonic()
        # The last row is sent twice: its answers are those to the SYNC after it.
        for row in chain(rows, [None]):
            if row is not None and row.index in pauses:
                watch.expected = loop.counts
                self._settle(kept)
                kept.pause()
                loop.hold_while(pauses[row.index], enabled, self._check)
            # The answers to this SYNC belong to the targets sent before it.
            watch.expected = loop.counts
            watch.gauge_watched = sent is not None and sent.on_circle
            feedback = loop.cycle(enabled, loop.counts if row is None else row.counts)
            self._check()
            if sent is not None and feedback.settled:
                kept.keep(sent, feedback)
            sent = row
            if loop.clock.real_time:
                self._settle(kept)
            elif feedback.cycle % verify_syncs == 0 or time.monotonic() - verified_s > VERIFY_S:
                self._settle(kept)
                verified_s = time.monotonic()

    def _settle(self, kept: Rows) -> None:
        """Accept what is certain: in real time an answer too many to the last SYNC may still come."""
        kept.settle(self._loop.confirm(), held=1 if self._loop.clock.real_time else 0)

    def _check(self) -> None:
        """Check the answers to the last SYNC; raises `MotionFaultError` if a check finds a fault."""
        watch, loop = self._watch, self._loop
        watch.supervision.count_missing(loop.feedback)
        watch.stalled, watch.missed = loop.last_missed, loop.missed
        watch.repeated, watch.last_repeated = loop.repeated
        watch.plausibility.update(loop.feedback, watch.expected, loop.last_missed, watch.gauge_watched)
        fault = find_fault(watch)
        if fault is not None:
            raise MotionFaultError(fault)

    def stop(self) -> list[str]:
        """Quick stop all axes together with frozen targets until the standstill of each is confirmed.

        An error of the bus does not end the attempt: it is repeated until `STOP_TIMEOUT_S` is over.

        Returns
        -------
        list of str
            One line for each axis whose standstill could not be confirmed; empty if all have stopped.
        """
        loop, frozen = self._loop, list(self._loop.counts)
        standstill = Standstill(loop.feedback.position)
        cycles, end_s = round(STOP_TIMEOUT_S / self._cycle_s), time.monotonic() + 2.0 * STOP_TIMEOUT_S
        lost: Exception | None = None
        while cycles > 0 and time.monotonic() < end_s:
            try:
                given_up = loop.give_up(self._watch.supervision.silent())
                feedback = loop.cycle([Command.QUICK_STOP] * 6, frozen)
                self._watch.supervision.count_missing(feedback)
                standstill.update(feedback)
            except Exception as error:  # whatever it is, the axes still move
                lost = error
                standstill.restart()
                time.sleep(self._cycle_s)
                continue
            lost, cycles = None, cycles - 1
            if all(self._stopped(slot, standstill) or slot in given_up for slot in range(6)):
                break
        if lost is not None:
            return [f"bus lost ({one_line(lost)}): the drives stop on their own when targets and heartbeat are missing"]
        return [self._unstopped(slot) for slot in range(6) if not self._stopped(slot, standstill)]

    def disable(self) -> None:
        """Disable the drives, axes at standstill; raises `RunError` if one does not reach the next state."""
        self._until(
            Command.SHUTDOWN, lambda feedback: not self._still_enabled(feedback), "ready to switch on", follow=False
        )
        self._until(
            Command.DISABLE_VOLTAGE, self._all_in(DriveState.SWITCH_ON_DISABLED), "switch on disabled", follow=False
        )

    def _stopped(self, slot: int, standstill: Standstill) -> bool:
        """Whether the standstill of an axis is confirmed, in a state in which it does not follow targets."""
        feedback = self._loop.feedback
        state = state_of(feedback.statusword[slot])
        return slot not in feedback.missing and state in STOPPED_STATES and standstill.confirmed(slot)

    def _unstopped(self, slot: int) -> str:
        """Return the message about an axis whose standstill is not confirmed."""
        feedback = self._loop.feedback
        if slot in feedback.missing:
            return f"{self._labels[slot]}: does not answer, standstill not confirmed"
        state = state_of(feedback.statusword[slot])
        if state not in STOPPED_STATES:
            return f"{self._labels[slot]}: object 6041:00 still reports {state.label}"
        return f"{self._labels[slot]}: object 6064:00 still changes"

    def _until(self, command: Command, reached: Callable[[Feedback], bool], what: str, follow: bool = True) -> Feedback:
        """Repeat one command until `reached`; targets follow the positions, or remain constant."""
        for _ in range(round(STEP_TIMEOUT_S / self._cycle_s)):
            counts = list(self._loop.feedback.position) if follow else self._loop.counts
            feedback = self._loop.cycle([command] * 6, counts)
            self._watch.supervision.count_missing(feedback)
            if self._watch.supervision.silent():
                break
            if not feedback.missing and reached(feedback):
                return feedback
        reported = "".join(f"; {each}" for each in self._reported())
        message = f"{self._culprit(reached)} (expected {what} within {STEP_TIMEOUT_S:g} s){reported}"
        raise RunError(blamed_before_motion(message, self._watch))

    def _reported(self) -> list[str]:
        """Return what nodes have reported of themselves, or sent malformed: the cause may lie in another node."""
        supervision = self._watch.supervision
        told = {**supervision.malformed, **supervision.emergencies}
        labels = dict(zip(supervision.nodes, self._labels, strict=True)) | {0: "bus"}
        return [f"{labels[node]} sent {each}" for node, each in told.items()]

    def _culprit(self, reached: Callable[[Feedback], bool]) -> str:
        """Return the message about the first node that did not reach the state, or about all where none answers."""
        feedback = self._loop.feedback
        if feedback.missing:
            slot = feedback.missing[0]
            who = "every node" if len(feedback.missing) == len(self._labels) else self._labels[slot]
            return f"{who}: TPDO1 missing{self._watch.lateness(slot)}"
        for slot, word in enumerate(feedback.statusword):
            alone = Feedback()
            alone.statusword = [word] * 6
            if not reached(alone):
                return f"{self._labels[slot]}: object 6041:00 is {word:04X}h, {state_of(word).label}"
        return "drives: no common state"

    @staticmethod
    def _all_in(state: DriveState) -> Callable[[Feedback], bool]:
        return lambda feedback: all(state_of(word) is state for word in feedback.statusword)

    @staticmethod
    def _still_enabled(feedback: Feedback) -> bool:
        return any(state_of(word) is DriveState.OPERATION_ENABLED for word in feedback.statusword)
