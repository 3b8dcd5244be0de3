"""The cyclic loop: targets, heartbeat of the controller, SYNC when it is due, answers.

Enabling, following a table, stopping and disabling all consist of this one cycle, so that the order of frames on the
bus is the same from the first to the last SYNC.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Collection, Sequence
from concurrent.futures import Future
from typing import TypeVar

import can

from hexdbb.capture.clock import Clock
from hexdbb.capture.cycle_times import CycleTimes
from hexdbb.capture.exchange import SLOTS, Exchange, Feedback
from hexdbb.capture.frames import HEARTBEAT_BASE
from hexdbb.capture.link import Link
from hexdbb.capture.realtime import give_way
from hexdbb.capture.settings import CONTROLLER_NODE
from hexdbb.capture.supervision import NMT_OPERATIONAL

T = TypeVar("T")
QUIET_S = 0.001
"""Silence on the bus after which, in lockstep, no answer is on its way, s: some five round trips of a socketcand server
on the same computer (0.1 to 0.3 ms). What comes later still is found by the next look."""
OWED_S = 0.08
"""Time after which, in real time, an answer that has not come is looked for once more, s: below the time without
targets after which drives stop (100 ms), which bounds how long a node may be held up."""
PAUSE_POLL_S = 0.005
"""Time between two repetitions of the targets during a pause in lockstep: well below the RPDO timeout (100 ms)."""
STALL_PATIENCE = 8
"""Answer timeouts to wait in lockstep while no node at all answers: 8 x 0.25 s. A simulated rig held up by a busy
desktop answers within that time; one that does not has ended."""


class Loop:
    """Runs communication cycles on a bus.

    Parameters
    ----------
    link : Link
        The network, inside `Link.looped`.
    exchange : Exchange
        Process data.
    clock : Clock
        Pace.
    heartbeat_s : float
        Period of the controller's heartbeat, s.
    cycle_s : float
        SYNC period, s.

    Attributes
    ----------
    cycle_index : int
        Time of motion of the last SYNC, in cycles from 0: missed cycles are counted, those of a pause are not.
    missed : int
        Cycles missed so far.
    last_missed : int
        Cycles missed immediately before the last SYNC.
    counts : list of int
        Targets sent last, counts, shape (6,).
    times : CycleTimes
        Histograms of the cycles since `restart_time`, for a display.
    while_waiting : callable
        Called in lockstep whenever the time for answers is over and some are missing: earlier SYNCs are settled by
        then, and the wait may be long.
    """

    def __init__(self, link: Link, exchange: Exchange, clock: Clock, heartbeat_s: float, cycle_s: float) -> None:
        self._link, self._exchange, self.clock = link, exchange, clock
        self._heartbeat_s, self._heartbeat_due_s = heartbeat_s, 0.0
        self._heartbeat = can.Message(
            arbitration_id=HEARTBEAT_BASE + CONTROLLER_NODE, is_extended_id=False, data=bytearray([NMT_OPERATIONAL])
        )
        self.cycle_index = -1
        self.missed = 0
        self.last_missed = 0
        self.counts: list[int] = [0] * 6
        self.times = CycleTimes()
        self.while_waiting: Callable[[], None] = nothing
        self._incomplete = False
        self._owing, self._owed_cycles = 0, max(2, round(OWED_S / cycle_s))
        clock.start()

    @property
    def feedback(self) -> Feedback:
        """Answers to the last SYNC."""
        return self._exchange.feedback

    @property
    def repeated(self) -> tuple[int, int | None]:
        """Number of answers too many so far, and the slot of the last one."""
        return self._exchange.repeated, self._exchange.last_repeated

    def cycle(self, controlwords: Sequence[int], counts: Sequence[int]) -> Feedback:
        """Send targets and SYNC, receive the answers.

        Parameters
        ----------
        controlwords : sequence of int
            Shape (6,).
        counts : sequence of int
            Targets in counts, shape (6,).

        Returns
        -------
        Feedback

        Raises
        ------
        can.CanError
            The bus is lost.
        """
        # In lockstep nothing passes between targets and SYNC unless answers are awaited: they leave together.
        together = not (self.clock.real_time or self._incomplete)
        self._send(controlwords, counts, with_targets=not together)
        self.last_missed = self.clock.wait()
        self.missed += self.last_missed
        self._exchange.drain()
        self._settle_answers()
        self.cycle_index += 1 + self.last_missed
        self._exchange.send_sync(with_targets=together)
        self.times.take(self._exchange.sync_s, self.last_missed)
        feedback = self._exchange.collect(self.clock.answer_timeout_s())
        if self.clock.real_time:
            self.times.latency.late.take(self.clock.late_s)
            if not feedback.missing:
                self.times.latency.answered.take(time.monotonic() - self._exchange.sync_s)
        elif feedback.missing:
            self.while_waiting()
            if len(feedback.missing) == SLOTS:
                self._wait_for_any(controlwords, counts)
                # Where the SYNC before has none, answers that come so late may be those to it.
                feedback.settled = feedback.settled and not self._incomplete
        self._incomplete = bool(feedback.missing)
        return feedback

    def _settle_answers(self) -> None:
        """Leave a SYNC out where answers to earlier ones are missing.

        Were another sent, a late answer would be taken for one to it, and so would all that follow. Where none came
        in a cycle it may be later still: some cycles on, another SYNC is left out. What comes then was asked before;
        where nothing comes, the answer was lost.
        """
        exchange = self._exchange
        if self._incomplete and exchange.is_waiting():
            self.last_missed += self.clock.let_pass(exchange.await_late)
            self._owing = 0
        exchange.end_waiting()
        if not exchange.owed:
            return
        self._owing += 1
        if not self.clock.real_time:
            exchange.forget_owed()  # a node of lockstep had half a second
        elif self._owing > self._owed_cycles:
            owed = exchange.owed
            self.last_missed += self.clock.let_pass(exchange.listen)
            self._owing = 0
            if exchange.owed == owed:
                exchange.forget_owed()

    @property
    def cost_of_a_lost_answer(self) -> int:
        """Samples that one lost answer costs in real time.

        Its own, those of two SYNCs left out to look for it, those in between, and one for the cycle it is found in.
        """
        return self._owed_cycles + 3 if self.clock.real_time else 1

    def confirm(self) -> bool:
        """Look whether every answer belonged to its SYNC since this was last called.

        Returns
        -------
        bool
            False where a node has answered once more than it was asked: some answers are another SYNC's.
        """
        # While answers are missing the silence has lasted longer already, and those that came now would not be paired.
        if not (self.clock.real_time or self._exchange.is_waiting()):
            self._exchange.drain(QUIET_S)
        doubtful, self._exchange.doubtful = self._exchange.doubtful, False
        return not doubtful

    def give_up(self, slots: Collection[int]) -> Collection[int]:
        """Stop waiting for the answers of some slots and return them; empty in real time, where waiting is free."""
        if self.clock.real_time:
            return ()
        self._exchange.give_up(slots)
        return slots

    def _wait_for_any(self, controlwords: Sequence[int], counts: Sequence[int]) -> None:
        """Wait longer for the answers to a SYNC that no node has answered, repeating the targets.

        If another SYNC were sent, its answers would be mistaken: every later sample would be one cycle off.
        """
        for _ in range(STALL_PATIENCE):
            self._send(controlwords, counts)
            if len(self._exchange.collect(self.clock.answer_timeout_s()).missing) < SLOTS:
                return
            self.while_waiting()

    def restart_time(self) -> None:
        """Restart the time of motion: the next SYNC has index 0."""
        self.cycle_index = -1
        self.missed = 0
        self.times.clear()

    def hold_while(
        self, work: Callable[[], T], controlwords: Sequence[int], check: Callable[[], None] = lambda: None
    ) -> T:
        """Hold the present targets while `work` runs in a thread that may use SDO.

        In lockstep no SYNC is sent meanwhile, so that the number of cycles does not depend on how long `work` takes.

        Parameters
        ----------
        work : callable
            Runs in a thread of its own.
        controlwords : sequence of int
            Shape (6,).
        check : callable
            Called in every cycle; an exception it raises ends the pause immediately and abandons the thread.

        Returns
        -------
        object
            The result of `work`; its exception is raised again.
        """
        counts, cycle_index = list(self.counts), self.cycle_index
        future: Future[T] = Future()
        threading.Thread(target=_run, args=(work, future), name="hexdbb-pause", daemon=True).start()
        while not future.done():
            if self.clock.real_time:
                self.cycle(controlwords, counts)
            else:
                self._send(controlwords, counts)
                self._exchange.listen(PAUSE_POLL_S)
            check()
        self._link.flush()
        self.times.pause()
        self.cycle_index = cycle_index
        return future.result()

    def _send(self, controlwords: Sequence[int], counts: Sequence[int], with_targets: bool = True) -> None:
        """Set the targets, and send them but where the SYNC takes them along; send what else is due."""
        self.counts = list(counts)
        self._exchange.set_targets(controlwords, counts)
        if with_targets:
            self._exchange.send_targets()
        self._link.flush()
        now_s = time.monotonic()
        if now_s >= self._heartbeat_due_s:
            self._link.bus.send(self._heartbeat)
            self._heartbeat_due_s = now_s + self._heartbeat_s


def nothing() -> None:
    """Do nothing."""


def _run(work: Callable[[], T], future: Future[T]) -> None:
    """Run the work of a pause and store its result or its exception; threads that it starts give way as it does."""
    give_way()
    try:
        future.set_result(work())
    except BaseException as error:  # raised again in the loop, which would otherwise wait for ever
        future.set_exception(error)
