"""A small plan, a rig in a thread or as a process, and `hexdbb-run`; what the rig holds is read over its bus."""

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
from tests.programs import called
from tests.rigs import rig_in_thread

from hexdbb.capture.cia402 import DriveState, state_of

PLAN = circle_plan()
"""One circle in four seconds; `RATE_HZ` keeps the number of cycles small."""

EXACT = 'schema = "hexdbb.truth/1"\ndrive = {lag_s = 1e-9}\ngauge = {noise_um = 0, resolution_um = 0}\n'
"""A machine without errors whose drives reach their targets: the record is known in advance."""

RATE_HZ = 50.0


@pytest.fixture
def command(plan: Path, tmp_path: Path) -> Callable[..., list[str]]:
    """Return the command line of `hexdbb-run` in lockstep, with the small plan and a record named `run.parquet`."""

    def line(*words: object) -> list[str]:
        program = str(Path(sys.executable).with_name("hexdbb-run"))
        standing = ("--plan", plan, "-o", tmp_path / "run.parquet", "--lockstep", "--rate", RATE_HZ)
        return [program, *map(str, (*standing, *words))]

    return line


@pytest.fixture
def run(plan: Path, tmp_path: Path) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Call `hexdbb-run` in lockstep at `RATE_HZ` unless options say otherwise; the record is named `run.parquet`."""

    def finished(*words: object) -> subprocess.CompletedProcess[str]:
        standing = ("--plan", plan, "-o", tmp_path / "run.parquet", "--lockstep", "--rate", RATE_HZ)
        return called("hexdbb-run", *standing, *words)

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


class RunningRig:
    """A running rig.

    Its objects are read after a run, over a connection of its own.
    """

    def __init__(self, address: str, log: Path) -> None:
        self.address, self.log = address, log
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

    def states(self, nodes: list[int]) -> list[DriveState]:
        return [state_of(self.read(node, 0x6041, "H")) for node in nodes]

    def velocities(self, nodes: list[int]) -> list[int]:
        return [self.read(node, 0x606C, "i") for node in nodes]


@pytest.fixture
def start_rig(tmp_path: Path) -> Callable[..., object]:
    """Return a context that serves a rig with options in a thread of the test."""

    @contextmanager
    def started(*options: object) -> Iterator[RunningRig]:
        log = tmp_path / "rig.log"
        with rig_in_thread(*options, log=log) as port:
            rig = RunningRig(f"127.0.0.1:{port}", log)
            try:
                yield rig
            finally:
                rig.close()

    return started


@pytest.fixture
def rig_process(tmp_path: Path) -> Iterator[tuple[RunningRig, subprocess.Popen[str]]]:
    """Start a rig as a process of its own."""
    log = tmp_path / "rig.log"
    command = [sys.executable, "-m", "hexdbb.cli", "rig", "-v", "--exit-with-parent"]
    with log.open("w") as err, subprocess.Popen(command, stdout=subprocess.PIPE, stderr=err, text=True) as process:
        assert process.stdout is not None
        rig = RunningRig(process.stdout.readline().split()[-1], log)
        try:
            yield rig, process
        finally:
            rig.close()
            process.terminate()
            process.wait(timeout=10)
