"""A small plan, the rig as a process, and `hexdbb-run` as another; what the rig holds is read over its bus."""

from __future__ import annotations

import struct
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import can
import pytest
from tests.circle_plan import circle_plan

from hexdbb.capture.cia402 import DriveState, state_of

PLAN = circle_plan()
"""One circle in four seconds; `RATE_HZ` keeps the number of cycles small."""

EXACT = 'schema = "hexdbb.truth/1"\ndrive = {lag_s = 1e-9}\ngauge = {noise_um = 0, resolution_um = 0}\n'
"""A machine without errors whose drives reach their targets: the record is known in advance."""

RATE_HZ = 100.0


@pytest.fixture
def command(plan: Path, tmp_path: Path) -> Callable[..., list[str]]:
    """Return the command line of `hexdbb-run` with the small plan and a record named `run.parquet`."""

    def line(*words: object) -> list[str]:
        program = str(Path(sys.executable).with_name("hexdbb-run"))
        return [program, *map(str, ("--plan", plan, "-o", tmp_path / "run.parquet", *words))]

    return line


@pytest.fixture
def run(command: Callable[..., list[str]]) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Run `hexdbb-run` in lockstep at `RATE_HZ` unless options say otherwise."""

    def finished(*words: object) -> subprocess.CompletedProcess[str]:
        line = command("--lockstep", "--rate", RATE_HZ, *words)
        return subprocess.run(line, capture_output=True, text=True, timeout=120)

    return finished


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    path = tmp_path / "plan.toml"
    path.write_text(PLAN)
    return path


@pytest.fixture
def exact(tmp_path: Path) -> Path:
    path = tmp_path / "truth.toml"
    path.write_text(EXACT)
    return path


class RigProcess:
    """A running rig.

    Its objects are read after a run, over a connection of its own.
    """

    def __init__(self, process: subprocess.Popen[str], address: str, log: Path) -> None:
        self.process, self.address, self.log = process, address, log
        self._observer: can.BusABC | None = None

    @property
    def bus(self) -> str:
        return f"socketcand:{self.address}"

    @property
    def observer(self) -> can.BusABC:
        if self._observer is None:
            host, _, port = self.address.rpartition(":")
            self._observer = can.Bus(interface="socketcand", host=host, port=int(port), channel="can0", tcp_tune=True)
            time.sleep(0.05)  # the rig sends nothing to a client that has only just connected
        return self._observer

    def read(self, node: int, index: int, code: str) -> int:
        """Read an object of up to four bytes (expedited upload)."""
        request = struct.pack("<BHBi", 0x40, index, 0, 0)
        self.observer.send(can.Message(arbitration_id=0x600 + node, data=request, is_extended_id=False))
        while (message := self.observer.recv(5.0)) is not None:
            if message.arbitration_id == 0x580 + node:
                assert message.data[0] & 0xF0 == 0x40
                (value,) = struct.unpack_from("<" + code, message.data, 4)
                return int(value)
        raise AssertionError(f"node {node} does not answer")

    def close(self) -> None:
        if self._observer is not None:
            self._observer.shutdown()
        self.process.terminate()
        self.process.wait(timeout=10)
        assert self.process.stdout is not None
        self.process.stdout.close()

    def states(self, nodes: list[int]) -> list[DriveState]:
        return [state_of(self.read(node, 0x6041, "H")) for node in nodes]

    def velocities(self, nodes: list[int]) -> list[int]:
        return [self.read(node, 0x606C, "i") for node in nodes]


@pytest.fixture
def start_rig(tmp_path: Path) -> Callable[..., object]:
    """Return a context that starts a rig with options and ends it."""

    @contextmanager
    def started(*options: object) -> Iterator[RigProcess]:
        log = tmp_path / "rig.log"
        command = [sys.executable, "-m", "hexdbb.cli", "rig", "-v", "--exit-with-parent", *map(str, options)]
        with log.open("w") as err:
            process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=err, text=True)
        assert process.stdout is not None
        rig = RigProcess(process, process.stdout.readline().split()[-1], log)
        try:
            yield rig
        finally:
            rig.close()

    return started
