"""A bus in memory with seven nodes that obey at once, and that a test lets misbehave."""

from __future__ import annotations

import struct
from collections import deque
from collections.abc import Callable, Iterator

import can

from hexdbb.capture.clock import Lockstep
from hexdbb.capture.exchange import Exchange
from hexdbb.capture.link import Link
from hexdbb.capture.loop import Loop
from hexdbb.capture.motion import AxisGroup
from hexdbb.capture.plausibility import Plausibility
from hexdbb.capture.supervision import Supervision
from hexdbb.capture.targets_ahead import Row
from hexdbb.capture.watch import Watch
from hexdbb.trajectory import Phase

DRIVES, GAUGE = (1, 2, 3, 4, 5, 6), 7
LABELS = (*(f"node {node} (slider {node})" for node in DRIVES), "node 7 (gauge)")
CYCLE_S = 0.004
HOMED = 0x8000
STATUSWORDS = {0x00: 0x0240, 0x80: 0x0240, 0x06: 0x0221, 0x07: 0x0223, 0x0F: 0x1227, 0x02: 0x0207}
"""Statusword after each controlword, of a drive that obeys."""


class ScriptedBus:
    """Answers every SYNC with the TPDOs of drives that stand exactly at their targets.

    `on_sync` is called with the number of a SYNC and may put frames before its answers; `on_recv` is called before
    every read and may raise; `silent` nodes send no TPDO; `stuck` drives keep their statusword.
    """

    def __init__(self) -> None:
        self.waiting: deque[can.Message] = deque()
        self.sent: list[tuple[int, bytes]] = []
        self.statusword = dict.fromkeys(DRIVES, 0x0240 | HOMED)
        self.position = dict.fromkeys(DRIVES, 0)
        self.silent: set[int] = set()
        self.stuck: set[int] = set()
        self.syncs = 0
        self.on_sync: Callable[[int], None] = lambda number: None
        self.on_recv: Callable[[], None] = lambda: None
        self.on_send: Callable[[], None] = lambda: None

    def put(self, can_id: int, data: bytes, **kind: bool) -> None:
        self.waiting.append(can.Message(arbitration_id=can_id, data=data, **{"is_extended_id": False, **kind}))

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        self.on_send()
        self.sent.append((msg.arbitration_id, bytes(msg.data)))
        if 0x200 < msg.arbitration_id <= 0x206:
            node = msg.arbitration_id - 0x200
            controlword, self.position[node] = struct.unpack("<Hi", msg.data)
            if node not in self.stuck:
                self.statusword[node] = STATUSWORDS[controlword] | HOMED
        elif msg.arbitration_id == 0x080:
            self.on_sync(self.syncs)
            self.syncs += 1
            self._answer()

    def recv(self, timeout: float | None = None) -> can.Message | None:
        self.on_recv()
        return self.waiting.popleft() if self.waiting else None

    def _answer(self) -> None:
        for node in DRIVES:
            if node not in self.silent:
                self.put(0x180 + node, struct.pack("<Hib", self.statusword[node], self.position[node], 8))
        if GAUGE not in self.silent:
            self.put(0x180 + GAUGE, struct.pack("<fB", 0.0, 0))


def axes_on(bus: ScriptedBus) -> AxisGroup:
    """The axes of a controller on a bus, in lockstep without patience."""
    link = Link(bus)
    supervision = Supervision([*DRIVES, GAUGE], link.notify, heartbeat_limit_s=60.0)
    exchange = Exchange(link.bus, DRIVES, GAUGE, supervision.on_frame)
    loop = Loop(link, exchange, Lockstep(patience_s=0.01), heartbeat_s=60.0, cycle_s=0.004)
    watch = Watch(
        feedback=exchange.feedback,
        supervision=supervision,
        labels=LABELS,
        window=1000,
        range_um=1000.0,
        counts_per_mm=1000.0,
        max_stall=25,
        max_missed=250,
        expected=loop.counts,
        plausibility=Plausibility(
            counts_per_mm=1000.0,
            cycle_s=CYCLE_S,
            velocity_mm_s=250.0,
            ball_mm_s=150.0,
            noise_um=0.0,
            repeats=1_000_000,
        ),
    )
    return AxisGroup(loop, watch, LABELS, cycle_s=CYCLE_S)


def at_rest(rows: int) -> Iterator[Row]:
    """Targets of axes that stay at 0, off the circle."""
    return (Row(row, [0] * 6, Phase.APPROACH, -1, False, [0.0] * 9) for row in range(rows))
