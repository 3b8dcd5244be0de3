"""Frames of a damaged bus, decoded as the controller does in motion: process data, EMCY, heartbeats, NMT, SDO.

The input is a text, one frame a line: identifier and data in hexadecimal. A line that is no frame is left out, since no
bus can carry it.
"""

from __future__ import annotations

from collections import deque
from functools import cache
from pathlib import Path

import can

from hexdbb.capture.boot import add_devices
from hexdbb.capture.checks import find_fault
from hexdbb.capture.exchange import Exchange
from hexdbb.capture.frames import GuardedBus
from hexdbb.capture.link import Link
from hexdbb.capture.supervision import NMT_OPERATIONAL, Supervision
from hexdbb.capture.watch import watch_over
from hexdbb.machine import shipped_machine
from hexdbb.plan import load_plan

DRIVE = "1{node:02X} 37 96 A0 86 01 00 08"
CYCLE = "\n".join([DRIVE.format(node=0x80 + node) for node in range(1, 7)] + ["187 00 00 80 3F 00"])
GOOD = f"""{CYCLE}
701 05
702 05
707 05
082 00 00 00 00 00 00 00 00
087 10 81 11 00 00 00 00 00
581 4B 41 60 00 37 96 00 00
583 80 64 60 00 00 00 02 06
000 01 00
080
7E5 44 00 00 00 00 00 00 00
555 00 11 22 33 44 55 66 77
{CYCLE}
"""
"""Two cycles, with frames of every other service between them."""
LABELS = (*(f"node {k} (slider {k})" for k in range(1, 7)), "node 7 (gauge)")


class ScriptedBus:
    """A bus that gives prepared frames and takes any."""

    channel_info = "scripted"

    def __init__(self, frames: list[can.Message]) -> None:
        self._frames = deque(frames)

    def recv(self, timeout: float | None = None) -> can.Message | None:
        """Return the next frame, or None after the last."""
        return self._frames.popleft() if self._frames else None

    def send(self, message: can.Message, timeout: float | None = None) -> None:
        """Drop a frame."""

    def __bool__(self) -> bool:
        return bool(self._frames)


@cache
def link() -> Link:
    """Return a network with the nodes of the shipped machine and no bus."""
    network = Link(None)
    add_devices(network, shipped_machine())
    return network


def frames_of(text: str) -> list[can.Message]:
    """Return the frames of a text."""
    frames = []
    for line in text.splitlines():
        words = line.split()
        try:
            can_id, data = int(words[0], 16), bytes(int(word, 16) for word in words[1:9])
            frames.append(can.Message(arbitration_id=can_id, data=data, is_extended_id=can_id > 0x7FF, check=True))
        except (ValueError, IndexError):
            continue
    return frames


def read(path: Path) -> object:
    """Decode the frames of a file cycle by cycle and return the messages of the faults they are."""
    bus, nodes = ScriptedBus(frames_of(path.read_text(errors="replace"))), list(range(1, 8))
    supervision = Supervision(nodes, link().notify, 0.3)
    exchange = Exchange(GuardedBus(bus), nodes[:6], 7, supervision.on_frame)
    machine, gauge = shipped_machine(), load_plan("thesis").gauge
    watch = watch_over(
        exchange, supervision, LABELS, machine, gauge, cycle_s=0.004, ball_mm_s=12.5, expected=[100_000] * 6
    )
    watch.gauge_watched = True
    for node in nodes:  # the network is made once; every input finds it as nodes that are operational leave it
        link().notify(0x700 + node, bytearray([NMT_OPERATIONAL]), 0.0)
    messages = []
    while bus:
        exchange.send_sync()
        exchange.collect(0.001)
        supervision.count_missing(exchange.feedback)
        fault = find_fault(watch)
        messages += [] if fault is None else [str(fault)]
    exchange.drain()
    return messages
