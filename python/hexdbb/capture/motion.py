"""Enable without a bump, follow a table, stop all axes together, disable.

Source: CiA 402 state machine. Assumption users get wrong: a drive is believed only when its statusword, mode display
and position say so; a command that was sent is not a command that was obeyed.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence

import can
import numpy as np
from numpy.typing import NDArray

from hexdbb.capture.checks import Fault, Watch, find_fault
from hexdbb.capture.cia402 import (
    CYCLIC_SYNCHRONOUS_POSITION,
    ENABLE_SEQUENCE,
    HOMED,
    Command,
    State,
    state_of,
)
from hexdbb.capture.exchange import Feedback
from hexdbb.capture.loop import Loop
from hexdbb.capture.transport import one_line
from hexdbb.errors import RunError

STEP_TIMEOUT_S = 2.0
"""Time every drive has for one step of its state machine, in cycles' time."""
STOP_TIMEOUT_S = 2.0
"""Time axes have to come to a stand."""
STAND_CYCLES = 10
"""Cycles a position must stay for an axis to count as standing."""
STAND_COUNTS = 2
"""Change of position between cycles that is encoder noise."""

STANDING_STATES = (State.QUICK_STOP_ACTIVE, State.SWITCH_ON_DISABLED, State.FAULT, State.READY_TO_SWITCH_ON)

Kept = Callable[[int, Feedback], None]
"""Takes the answers that belong to a row of the table."""


class MotionFaultError(RunError):
    """A fault was found while axes were enabled."""

    def __init__(self, fault: Fault) -> None:
        super().__init__(str(fault))
        self.fault = fault


class Motion:
    """Moves the six axes.

    Parameters
    ----------
    loop : runs the cycles
    watch : what the checks look at
    labels : name of each drive and of the gauge
    cycle_s : time between two SYNCs
    """

    def __init__(self, loop: Loop, watch: Watch, labels: Sequence[str], cycle_s: float) -> None:
        self._loop, self._watch, self._labels, self._cycle_s = loop, watch, labels, cycle_s

    def stand(self) -> list[int]:
        """Ask where the axes stand, disabled; returns six positions in counts.

        Raises
        ------
        RunError
            A node does not answer, shows another mode, is not homed, or has a fault that a reset does not clear.
        """
        for command in (Command.DISABLE_VOLTAGE, Command.FAULT_RESET, Command.DISABLE_VOLTAGE):
            feedback = self._until(command, lambda feedback: not feedback.missing, "an answer to SYNC")
        self._until(Command.DISABLE_VOLTAGE, self._all_in(State.SWITCH_ON_DISABLED), "switch on disabled")
        in_mode = [mode == CYCLIC_SYNCHRONOUS_POSITION for mode in feedback.mode]
        if not all(in_mode):
            slot = in_mode.index(False)
            raise RunError(
                f"{self._labels[slot]}: object 6061:00 is {feedback.mode[slot]} "
                f"(expected {CYCLIC_SYNCHRONOUS_POSITION}, as commanded in 6060:00)"
            )
        return list(feedback.position)

    def check_homed(self) -> None:
        """Raise `RunError` where a drive does not say that its position is referenced."""
        for label, word in zip(self._labels, self._loop.feedback.statusword, strict=False):
            if not word & HOMED:
                raise RunError(f"{label}: object 6041:00 is {word:04X}h, not homed (expected bit 15)")

    def enable(self) -> list[int]:
        """Enable operation with each target where its axis stands; returns the targets.

        Raises
        ------
        RunError
            A drive does not go along; stopping all of them is the caller's business.
        """
        for command, state in ENABLE_SEQUENCE:
            if state is State.OPERATION_ENABLED:
                # Held from here on: a target that went on following the position would let the axis drift.
                self._loop.counts = list(self._loop.feedback.position)
            self._until(command, self._all_in(state), state.label, follow=state is not State.OPERATION_ENABLED)
        return list(self._loop.counts)

    def follow(
        self,
        counts: NDArray[np.int32],
        gauge_watched: NDArray[np.bool_],
        keep: Kept,
        pauses: Mapping[int, Callable[[], None]],
    ) -> None:
        """Send a table's rows, one per cycle, check every answer, and hand over those that belong to a row.

        Parameters
        ----------
        counts : (n, 6) targets
        gauge_watched : (n,) rows in which the reading must be good
        keep : called with a row's number and the answers that belong to it
        pauses : what to do before a row is sent, targets held meanwhile

        Raises
        ------
        MotionFaultError
            A check found a fault; the targets stay where they were.
        can.CanError
            The bus is gone.
        """
        enabled = [Command.ENABLE_OPERATION] * 6
        watch, loop = self._watch, self._loop
        # A heartbeat sent before the nodes were started may have been on its way until now.
        watch.supervision.nmt_states.clear()
        rows = len(counts)
        for row in range(rows + 1):
            if row in pauses:
                watch.expected = loop.counts
                loop.hold_while(pauses[row], enabled, self._check)
            # The answers to this SYNC show where the targets sent before it have led.
            watch.expected = loop.counts
            watch.gauge_watched = row > 0 and bool(gauge_watched[row - 1])
            feedback = loop.cycle(enabled, counts[min(row, rows - 1)].tolist())
            self._check()
            if row and feedback.settled:
                keep(row - 1, feedback)

    def _check(self) -> None:
        """Look at the answers to the last SYNC; raises `MotionFaultError` where a check finds a fault."""
        watch, loop = self._watch, self._loop
        watch.supervision.count_missing(loop.feedback)
        watch.stalled, watch.missed = loop.last_missed, loop.missed
        fault = find_fault(watch)
        if fault is not None:
            raise MotionFaultError(fault)

    def stop(self) -> list[str]:
        """Quick stop on all axes together, targets frozen, until every one is seen to stand.

        Returns
        -------
        list of str
            One line for each axis that could not be seen to have stopped; empty when all have.
        """
        loop, frozen = self._loop, list(self._loop.counts)
        supervision = self._watch.supervision
        still = [0] * 6
        before = list(loop.feedback.position)
        end_s = time.monotonic() + 2.0 * STOP_TIMEOUT_S
        try:
            for _ in range(round(STOP_TIMEOUT_S / self._cycle_s)):
                given_up = loop.give_up(supervision.silent())
                feedback = loop.cycle([Command.QUICK_STOP] * 6, frozen)
                supervision.count_missing(feedback)
                for slot, position in enumerate(feedback.position):
                    rests = slot not in feedback.missing and abs(position - before[slot]) <= STAND_COUNTS
                    still[slot] = still[slot] + 1 if rests else 0
                before = list(feedback.position)
                done = all(self._stopped(slot, still) or slot in given_up for slot in range(6))
                if done or time.monotonic() > end_s:
                    break
        except (can.CanError, OSError) as error:
            gone = f"the bus is gone ({one_line(error)})"
            return [f"{gone}: the drives stop by themselves when targets and heartbeat stay out"]
        return [self._unstopped(slot) for slot in range(6) if not self._stopped(slot, still)]

    def disable(self) -> None:
        """Take the drives out of operation, axes standing; raises `RunError` where one does not go along."""
        self._until(
            Command.SHUTDOWN, lambda feedback: not self._still_enabled(feedback), "ready to switch on", follow=False
        )
        self._until(Command.DISABLE_VOLTAGE, self._all_in(State.SWITCH_ON_DISABLED), "switch on disabled", follow=False)

    def _stopped(self, slot: int, still: Sequence[int]) -> bool:
        """Whether an axis is seen to stand in a state in which it does not follow targets."""
        feedback = self._loop.feedback
        state = state_of(feedback.statusword[slot])
        return slot not in feedback.missing and state in STANDING_STATES and still[slot] >= STAND_CYCLES

    def _unstopped(self, slot: int) -> str:
        """Say what an axis that is not seen to stand does."""
        feedback = self._loop.feedback
        if slot in feedback.missing:
            return f"{self._labels[slot]}: does not answer, not seen to have stopped"
        state = state_of(feedback.statusword[slot])
        if state not in STANDING_STATES:
            return f"{self._labels[slot]}: object 6041:00 still says {state.label}"
        return f"{self._labels[slot]}: object 6064:00 still moves"

    def _until(self, command: Command, reached: Callable[[Feedback], bool], what: str, follow: bool = True) -> Feedback:
        """Cycle with one command until `reached`; targets follow the positions, or stay."""
        for _ in range(round(STEP_TIMEOUT_S / self._cycle_s)):
            counts = list(self._loop.feedback.position) if follow else self._loop.counts
            feedback = self._loop.cycle([command] * 6, counts)
            self._watch.supervision.count_missing(feedback)
            if self._watch.supervision.silent():
                break
            if not feedback.missing and reached(feedback):
                return feedback
        raise RunError(f"{self._culprit(reached)} (expected {what} within {STEP_TIMEOUT_S:g} s)")

    def _culprit(self, reached: Callable[[Feedback], bool]) -> str:
        """Name the first node that did not go along."""
        feedback = self._loop.feedback
        if feedback.missing:
            return f"{self._labels[feedback.missing[0]]}: TPDO1 stays out"
        for slot, word in enumerate(feedback.statusword):
            alone = Feedback()
            alone.statusword = [word] * 6
            if not reached(alone):
                emergency = self._watch.supervision.emergencies.get(self._watch.supervision.nodes[slot])
                reason = f", EMCY {emergency.code:04X}h" if emergency else ""
                return f"{self._labels[slot]}: object 6041:00 is {word:04X}h, {state_of(word).label}{reason}"
        return "drives: no common state"

    @staticmethod
    def _all_in(state: State) -> Callable[[Feedback], bool]:
        return lambda feedback: all(state_of(word) is state for word in feedback.statusword)

    @staticmethod
    def _still_enabled(feedback: Feedback) -> bool:
        return any(state_of(word) is State.OPERATION_ENABLED for word in feedback.statusword)
