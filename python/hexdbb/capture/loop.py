"""The cyclic loop: every cycle targets, controller heartbeat, SYNC at its time, answers.

Enabling, following a table, stopping and disabling are all made of this one cycle, so that from the first to the last
SYNC no other frame order exists on the bus.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Collection, Sequence
from concurrent.futures import Future
from typing import TypeVar

import can

from hexdbb.capture.clock import Clock
from hexdbb.capture.exchange import SLOTS, Exchange, Feedback
from hexdbb.capture.link import Link
from hexdbb.capture.settings import CONTROLLER_NODE

HEARTBEAT_BASE = 0x700
NMT_OPERATIONAL = 0x05
T = TypeVar("T")
PAUSE_POLL_S = 0.005
STALL_PATIENCE = 8
"""Times a rig that does not answer at all is waited for in lockstep: it is held up, or gone."""


class Loop:
    """Runs cycles on a bus.

    Parameters
    ----------
    link : the network, inside `Link.looped`
    exchange : process data
    clock : pace
    heartbeat_s : period of the controller's heartbeat

    Attributes
    ----------
    slot : number of the slot of the last SYNC, missed ones counted, held ones not: time of motion in cycles
    missed : slots missed so far
    counts : targets sent last
    """

    def __init__(self, link: Link, exchange: Exchange, clock: Clock, heartbeat_s: float) -> None:
        self._link, self._exchange, self.clock = link, exchange, clock
        self._heartbeat_s, self._heartbeat_due_s = heartbeat_s, 0.0
        self._heartbeat = can.Message(
            arbitration_id=HEARTBEAT_BASE + CONTROLLER_NODE, is_extended_id=False, data=bytearray([NMT_OPERATIONAL])
        )
        self.slot = -1
        self.missed = 0
        self.last_missed = 0
        self.counts: list[int] = [0] * 6
        clock.start()

    @property
    def feedback(self) -> Feedback:
        """Answers to the last SYNC."""
        return self._exchange.feedback

    def cycle(self, controlwords: Sequence[int], counts: Sequence[int]) -> Feedback:
        """Send targets and SYNC, receive the answers.

        Raises
        ------
        can.CanError
            The bus is gone.
        """
        self._send(controlwords, counts)
        self.last_missed = self.clock.wait()
        self.missed += self.last_missed
        self.slot += 1 + self.last_missed
        if self.clock.real_time:
            self._exchange.drain()
        self._exchange.send_sync()
        feedback = self._exchange.collect(self.clock.answer_timeout_s())
        if len(feedback.missing) == SLOTS and not self.clock.real_time:
            self._wait_for_any(controlwords, counts)
        return feedback

    def give_up(self, slots: Collection[int]) -> Collection[int]:
        """Wait no longer for the answers of some slots; returns them; none in real time: waiting is free."""
        if self.clock.real_time:
            return ()
        self._exchange.give_up(slots)
        return slots

    def _wait_for_any(self, controlwords: Sequence[int], counts: Sequence[int]) -> None:
        """Wait longer for a SYNC nobody has answered, targets kept alive.

        Another SYNC would be answered with the answers to this one, and every later sample would be one cycle off.
        """
        for _ in range(STALL_PATIENCE):
            self._send(controlwords, counts)
            if len(self._exchange.collect(self.clock.answer_timeout_s()).missing) < SLOTS:
                return

    def restart_time(self) -> None:
        """Count time from here on: the next SYNC is in slot 0."""
        self.slot = -1
        self.missed = 0

    def hold_while(
        self, work: Callable[[], T], controlwords: Sequence[int], check: Callable[[], None] = lambda: None
    ) -> T:
        """Hold the present targets while `work` runs in a thread that may use SDO; its result or exception comes back.

        In lockstep no SYNC is sent meanwhile, so that the number of cycles does not depend on how long it takes.
        `check` is called all along; what it raises ends the hold at once, and leaves the thread to itself.
        """
        counts, slot = list(self.counts), self.slot
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
        self.slot = slot
        return future.result()

    def _send(self, controlwords: Sequence[int], counts: Sequence[int]) -> None:
        self.counts = list(counts)
        self._exchange.send_targets(controlwords, counts)
        self._link.flush()
        now_s = time.monotonic()
        if now_s >= self._heartbeat_due_s:
            self._link.bus.send(self._heartbeat)
            self._heartbeat_due_s = now_s + self._heartbeat_s


def _run(work: Callable[[], T], future: Future[T]) -> None:
    """Do the work of a pause, and hand its result or its exception over."""
    try:
        future.set_result(work())
    except BaseException as error:  # whatever it is, it is raised again in the loop, which would wait for ever
        future.set_exception(error)
