"""The man in the middle: a proxy between a controller and the simulated rig that applies rules to every frame.

One thread serves all connections. A controller's connection gets one of its own to the rig; messages that arrive
together leave together, so that the proxy without rules changes nothing but time.
"""

from __future__ import annotations

import heapq
import itertools
import random
import selectors
import socket
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from tests.faults.bus_log import BusLog
from tests.faults.messages import Way, parse, split
from tests.faults.transformations import Emission, Rule

RECEIVE_BYTES = 65536
IDLE_S = 0.02
"""Longest time until the proxy sees that it is to end, s."""

WRITE_TIMEOUT_S = 5.0
"""Longest time for which a receiver may leave its frames unread, s; then its connection is broken."""


class _End:
    """One end of a connection through the proxy."""

    def __init__(self, connection: socket.socket, leads: Way) -> None:
        self.connection, self.leads = connection, leads
        self.buffer = b""
        self.other: _End


class Proxy:
    """A proxy on 127.0.0.1.

    Parameters
    ----------
    rig_port : int
        Port of the rig.
    rules : sequence of Rule
        Applied in order; the first that matches a frame decides on it.
    cycle_s : float
        SYNC period, s: machine time is counted in SYNCs.
    seed : int
        Seed of random transformations.
    """

    def __init__(self, rig_port: int, rules: Sequence[Rule], cycle_s: float, seed: int) -> None:
        self.rules, self.log = list(rules), BusLog()
        self._rig_port, self._cycle_s, self._rng = rig_port, cycle_s, random.Random(seed)
        self._selector = selectors.DefaultSelector()
        self._listener = socket.create_server(("127.0.0.1", 0))
        self._selector.register(self._listener, selectors.EVENT_READ)
        self._ends: list[_End] = []
        self._running = True
        self._numbers = itertools.count()
        self._timed: list[tuple[float, int, Emission]] = []
        self._after_sync: list[tuple[int, Emission]] = []
        self._after_message: list[Emission] = []

    @property
    def bus(self) -> str:
        """Name of the bus for ``hexdbb-run --bus``."""
        return f"socketcand:127.0.0.1:{self._listener.getsockname()[1]}"

    @property
    def fired(self) -> int:
        """Frames transformed so far."""
        return sum(rule.fired for rule in self.rules)

    def serve(self) -> None:
        """Serve until `end`."""
        while self._running:
            wait_s = IDLE_S if not self._timed else max(0.0, min(IDLE_S, self._timed[0][0] - time.monotonic()))
            for key, _ in self._selector.select(wait_s):
                if key.data is None:
                    self._accept()
                elif key.data in self._ends:
                    self._read(key.data)
            self._send_what_is_due()
        for end in list(self._ends):
            self._drop(end)
        self._selector.unregister(self._listener)
        self._listener.close()
        self._selector.close()

    def end(self) -> None:
        """End `serve` soon."""
        self._running = False

    def _accept(self) -> None:
        controller = _End(self._listener.accept()[0], Way.TO_NODES)
        try:
            rig = _End(socket.create_connection(("127.0.0.1", self._rig_port)), Way.TO_CONTROLLER)
        except OSError:
            controller.connection.close()
            return
        controller.other, rig.other = rig, controller
        for end in (controller, rig):
            end.connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            end.connection.settimeout(WRITE_TIMEOUT_S)
            self._ends.append(end)
            self._selector.register(end.connection, selectors.EVENT_READ, end)

    def _drop(self, end: _End) -> None:
        for each in (end, end.other):
            if each in self._ends:
                self._ends.remove(each)
                self._selector.unregister(each.connection)
                each.connection.close()

    def _read(self, end: _End) -> None:
        try:
            received = end.connection.recv(RECEIVE_BYTES)
        except OSError:
            received = b""
        if not received:
            self._drop(end)
            return
        messages, end.buffer = split(end.buffer + received)
        out: dict[Way, list[bytes]] = {way: [] for way in Way}
        for message in messages:
            self._take(message, end.leads, out)
        for way, parts in out.items():
            self._write(end.other if way is end.leads else end, b"".join(parts))

    def _take(self, message: bytes, way: Way, out: dict[Way, list[bytes]]) -> None:
        """Note a message, apply the rules to it, and collect what is to be sent at once."""
        frame = parse(message)
        if frame is None:
            out[way].append(message)
            return
        (self.log.sent if way is Way.TO_NODES else self.log.answered)(frame)
        cycles = self.log.since_enabled
        running_s = None if cycles is None else cycles * self._cycle_s
        rule = next((rule for rule in self.rules if rule.matches(frame, way, running_s)), None)
        emissions = [Emission(message, way)] if rule is None else rule.apply(frame, way, self._rng)
        waiting = [emission for emission in self._after_message if emission.way is way]
        for emission in emissions:
            self._emit(emission, out)
        for emission in waiting:
            self._after_message.remove(emission)
            self._leave(emission, out)

    def _emit(self, emission: Emission, out: dict[Way, list[bytes]]) -> None:
        if emission.seconds:
            due_s = time.monotonic() + emission.seconds
            heapq.heappush(self._timed, (due_s, next(self._numbers), emission))
        elif emission.syncs:
            self._after_sync.append((len(self.log.cycles) + emission.syncs, emission))
        elif emission.messages:
            self._after_message.append(emission)
        else:
            self._leave(emission, out)

    def _leave(self, emission: Emission, out: dict[Way, list[bytes]]) -> None:
        """Add a message to those that are sent at once, and what was waiting for it."""
        if emission.message is None:
            for end in list(self._ends):
                self._drop(end)
            return
        out[emission.way].append(emission.message)
        frame = parse(emission.message) if emission.way is Way.TO_NODES else None
        if frame is None:
            return
        self.log.received(frame)
        if self.log.is_sync(frame, emission.way):
            due = [waiting for waiting in self._after_sync if waiting[0] <= len(self.log.cycles)]
            for waiting in due:
                self._after_sync.remove(waiting)
                self._leave(waiting[1], out)

    def _send_what_is_due(self) -> None:
        """Send one message whose time has come: in a flood, other messages take their turns."""
        if self._timed and self._timed[0][0] <= time.monotonic():
            _, _, emission = heapq.heappop(self._timed)
            out: dict[Way, list[bytes]] = {way: [] for way in Way}
            self._leave(emission, out)
            for end in list(self._ends):
                self._write(end, b"".join(out[end.other.leads]))

    def _write(self, end: _End, data: bytes) -> None:
        if data and end in self._ends:
            try:
                end.connection.sendall(data)
            except OSError:
                self._drop(end)


@contextmanager
def proxied(rig_port: int, rules: Sequence[Rule], cycle_s: float, seed: int = 0) -> Iterator[Proxy]:
    """Run a proxy in a thread for the length of the context."""
    proxy = Proxy(rig_port, rules, cycle_s, seed)
    thread = threading.Thread(target=proxy.serve, name="proxy", daemon=True)
    thread.start()
    try:
        yield proxy
    finally:
        proxy.end()
        thread.join()
