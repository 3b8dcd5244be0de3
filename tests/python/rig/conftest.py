"""A controller for the tests of the rig: python-can and canopen over a real TCP connection to a rig."""

from __future__ import annotations

import logging
import struct
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager
from functools import cache
from pathlib import Path

import can
import canopen
import pytest
from tests.rigs import rig_in_thread

from hexdbb.machine import shipped

DRIVES, GAUGE = range(1, 7), 7
WAIT_S = 20.0
ENABLE = (0x06, 0x07, 0x0F)
CUP_MM, BALL_MM, BAR_MM = (0.0, 0.0, 340.0), (0.0, 0.0, 60.0), 100.0


@cache
def dictionary(node: int) -> canopen.ObjectDictionary:
    """Return a node's objects, which tests do not change."""
    name = "ballbar_gauge.eds" if node == GAUGE else "hexglider_drive.eds"
    return canopen.import_od(str(shipped("eds", name)), node)


class Controller:
    """Master of the rig's bus."""

    def __init__(self, port: int) -> None:
        logging.getLogger("can.interfaces.socketcand").setLevel(logging.ERROR)
        self.bus = can.Bus(interface="socketcand", channel="can0", host="127.0.0.1", port=port, tcp_tune=True)
        self.network = canopen.Network(self.bus)
        self.nodes = {
            node: self.network.add_node(canopen.RemoteNode(node, dictionary(node))) for node in (*DRIVES, GAUGE)
        }
        for node in self.nodes.values():
            node.sdo.RESPONSE_TIMEOUT = WAIT_S
        self.other: list[can.Message] = []
        self._notifier: can.Notifier | None = None

    def talk(self) -> None:
        """Let canopen receive: SDO, NMT states."""
        if self._notifier is None:
            self._notifier = can.Notifier(self.bus, self.network.listeners, 0.1)

    def loop(self) -> None:
        """Receive in the loop again."""
        if self._notifier is not None:
            self._notifier.stop()
            self._notifier = None

    def close(self) -> None:
        self.loop()
        self.bus.shutdown()

    def nmt(self, command: int, node: int = 0) -> None:
        self.network.nmt.send_command(command) if node == 0 else self.nodes[node].nmt.send_command(command)

    def frame(self, cob_id: int, data: bytes = b"") -> None:
        self.bus.send(can.Message(arbitration_id=cob_id, data=data, is_extended_id=False))

    def receive(self, wanted: Callable[[can.Message], bool], wait_s: float = WAIT_S) -> can.Message | None:
        """Return the next wanted frame; others are appended to `other`."""
        end = time.monotonic() + wait_s
        while time.monotonic() < end:
            message = self.bus.recv(min(wait_s, 0.2))
            if message is not None and wanted(message):
                return message
            if message is not None:
                self.other.append(message)
        return None

    def configure(self, period_us: int = 4000) -> None:
        self.talk()
        for node in DRIVES:
            self.nodes[node].sdo[0x6060].raw = 8
            self.nodes[node].sdo[0x1006].raw = period_us

    def mount(self, number: int = 1, cup_mm: Sequence[float] = CUP_MM, ball_mm: Sequence[float] = BALL_MM) -> None:
        self.talk()
        record = self.nodes[GAUGE].sdo[0x2100]
        for subindex, value in enumerate((*cup_mm, *ball_mm, BAR_MM), start=2):
            record[subindex].raw = value
        record[1].raw = number

    def positions(self) -> list[int]:
        self.talk()
        return [self.nodes[node].sdo[0x6064].raw for node in DRIVES]

    def cycle(
        self, controlword: int, counts: Sequence[int], tpdos: int = 7, wait_s: float = WAIT_S
    ) -> dict[int, bytes]:
        """Send six targets and SYNC, collect the answers by node."""
        for node, target in zip(DRIVES, counts, strict=True):
            self.frame(0x200 + node, struct.pack("<Hi", controlword, target))
        self.frame(0x80)
        answers: dict[int, bytes] = {}
        while len(answers) < tpdos:
            message = self.receive(lambda m: 0x180 < m.arbitration_id < 0x200, wait_s)
            if message is None:
                break
            answers[message.arbitration_id - 0x180] = bytes(message.data)
        return answers

    def enable(self, counts: Sequence[int]) -> None:
        """Bring all drives to operation enabled, bumpless."""
        self.loop()
        for word in ENABLE:
            for _ in range(2):
                self.cycle(word, counts)

    @staticmethod
    def statuswords(answers: dict[int, bytes]) -> list[int]:
        return [struct.unpack_from("<H", answers[node])[0] for node in DRIVES]

    def emergencies(self, node: int) -> list[int]:
        """Error codes of the EMCYs received from a node while cycling."""
        found = [m for m in self.other if m.arbitration_id == 0x80 + node and len(m.data) == 8]
        return [struct.unpack_from("<H", message.data)[0] for message in found]

    def ready(self) -> list[int]:
        """Configure, start and enable; return the slider positions in counts."""
        self.configure()
        counts = self.positions()
        self.nmt(0x01)
        self.enable(counts)
        return counts


Start = Callable[..., Controller]


@contextmanager
def _rig_process(*arguments: str) -> Iterator[tuple[int, subprocess.Popen[str]]]:
    """Run a rig on a free port; yield port and process."""
    command = [sys.executable, "-c", "from hexdbb.cli import main; main()", "rig", "--port", "0", "--exit-with-parent"]
    with subprocess.Popen([*command, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            line = process.stdout.readline()
            assert line.startswith("hexdbb rig: listening on 127.0.0.1:"), (line, process.communicate())
            yield int(line.rsplit(":", 1)[1]), process
        finally:
            process.terminate()
            process.communicate(timeout=WAIT_S)


@pytest.fixture
def rig_process() -> Callable[..., AbstractContextManager[tuple[int, subprocess.Popen[str]]]]:
    """Return a context that starts a rig with options and yields its port and process."""
    return _rig_process


@pytest.fixture
def connect() -> Callable[[int], Controller]:
    """Return a controller on the bus of a port."""
    return Controller


@pytest.fixture
def start() -> Iterator[Start]:
    """Serve a rig with options in a thread, and connect a controller to its bus."""
    with ExitStack() as stack:

        def begin(*arguments: str) -> Controller:
            port = stack.enter_context(rig_in_thread(*arguments))
            controller = Controller(port)
            stack.callback(controller.close)
            return controller

        yield begin


@pytest.fixture
def truth_file(tmp_path: Path) -> Callable[[str], str]:
    """Write a truth file of this content."""

    def write(content: str) -> str:
        path = tmp_path / "truth.toml"
        path.write_text('schema = "hexdbb.truth/1"\n' + content, encoding="utf-8")
        return str(path)

    return write
