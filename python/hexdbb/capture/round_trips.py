"""Wake-ups and round trips measured without moving anything: at the deadlines of a rate, one SDO question a cycle.

A node's device type (object 1000h) is read, which every device answers in every state but stopped. An SDO answer takes
longer than a TPDO on most devices: the answer to SYNC in a run comes earlier.
Source: CiA 301, expedited SDO upload.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from itertools import cycle

import can

from hexdbb.capture.clock import Deadlines
from hexdbb.capture.frames import SDO_ANSWER_BASE, GuardedBus
from hexdbb.capture.latency import Latency

SDO_QUESTION_BASE = 0x600
READ_DEVICE_TYPE = bytes([0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0])


def measured_latency(
    rate_hz: float,
    seconds: float,
    bus: can.BusABC | None = None,
    nodes: Sequence[int] = (),
    progress: Callable[[float], None] = lambda share: None,
) -> tuple[Latency, dict[int, int]]:
    """Measure how late this computer wakes at the deadlines of a rate, and how soon nodes answer.

    Parameters
    ----------
    rate_hz : float
    seconds : float
        How long.
    bus : can.BusABC, optional
        An open bus; None measures the computer alone.
    nodes : sequence of int
        Node ids that are asked in turn.
    progress : callable
        Called with the share that is done, some ten times a second.

    Returns
    -------
    Latency
        Wake-ups, and times to the answers.
    dict of int to int
        Questions of each node that remained without an answer until the next one.
    """
    clock, latency, cycles = Deadlines(1.0 / rate_hz), Latency(), max(1, round(seconds * rate_hz))
    guarded, unanswered = None if bus is None else GuardedBus(bus), dict.fromkeys(nodes, 0)
    asked, told = cycle(nodes or (0,)), max(1, round(0.1 * rate_hz))
    clock.start()
    done = 0
    while done < cycles:
        missed = clock.wait()
        latency.late.take(clock.late_s)
        if guarded is not None and nodes:
            node = next(asked)
            answered_s = _asked(guarded, node, clock.answer_timeout_s())
            if answered_s is None:
                unanswered[node] += 1
            else:
                latency.answered.take(answered_s)
        if done % told == 0:
            progress(done / cycles)
        done += 1 + missed
    return latency, unanswered


def _asked(bus: GuardedBus, node: int, timeout_s: float) -> float | None:
    """Return the time to a node's answer, s; None where none comes in time."""
    while bus.recv(0.0) is not None:
        pass  # late answers, heartbeats
    bus.send(can.Message(arbitration_id=SDO_QUESTION_BASE + node, is_extended_id=False, data=READ_DEVICE_TYPE))
    sent_s = time.monotonic()
    while (left_s := sent_s + timeout_s - time.monotonic()) > 0.0:
        message = bus.recv(left_s)
        if message is not None and message.arbitration_id == SDO_ANSWER_BASE + node:
            return time.monotonic() - sent_s
    return None
