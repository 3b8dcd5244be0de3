"""Buses to measure on and the pace of a run: a named CAN bus, or a simulated rig that is started for it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

import can

from hexdbb.capture.clock import Clock, Deadlines, Lockstep
from hexdbb.capture.realtime import real_time_process
from hexdbb.capture.request import RunProgress
from hexdbb.capture.simulated import simulated_rig
from hexdbb.capture.transport import open_bus
from hexdbb.machine import MachineFile


@dataclass(frozen=True)
class SimulatedRig:
    """A simulated rig, started as a process of its own for one run and ended after it.

    Attributes
    ----------
    truth : Path, optional
        Truth file: errors and mechanisms of the hidden machine.
    seed : int, optional
        Seed of a random hidden machine, or of the noise of a truth file.
    faults : tuple of str
        Faults to inject, as ``hexdbb rig --fault`` takes them.
    """

    truth: Path | None = None
    seed: int | None = None
    faults: tuple[str, ...] = ()

    @property
    def options(self) -> list[str]:
        """Options of ``hexdbb rig``."""
        options = [] if self.truth is None else ["--truth", str(self.truth)]
        options += [] if self.seed is None else ["--seed", str(self.seed)]
        return options + [word for fault in self.faults for word in ("--fault", fault)]


@contextmanager
def opened_bus(bus: str | SimulatedRig, machine: MachineFile) -> Iterator[can.BusABC]:
    """Open a bus named as ``interface:channel``, or start a simulated rig and open its bus.

    Raises
    ------
    InputError, RunError
        The bus cannot be opened, or the rig did not start.
    """
    with ExitStack() as stack:
        if isinstance(bus, SimulatedRig):
            own = [] if machine.path is None else ["--machine", str(machine.path)]
            bus = stack.enter_context(simulated_rig([*own, *bus.options]))
        yield stack.enter_context(open_bus(bus, machine.can_setup.bitrate_bit_s))


@contextmanager
def running_clock(lockstep: bool, cycle_s: float, progress: RunProgress) -> Iterator[Clock]:
    """Yield the clock of a run; in real time, with the real-time scheduling that the system grants."""
    if lockstep:
        yield Lockstep()
        return
    with real_time_process() as refused:
        progress.notes += refused
        yield Deadlines(cycle_s)
