"""Cycles in lockstep on a bus in memory, targets read from their file: does memory grow with their number?"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from tests.python.capture.scripted_bus import CYCLE_S, ScriptedBus, axes_on

from hexdbb.capture.captured_rows import CapturedRows
from hexdbb.capture.request import RunProgress
from hexdbb.capture.sample_buffer import SampleBuffer
from hexdbb.capture.targets_ahead import Row, TargetsAhead
from hexdbb.plan import load_plan
from hexdbb.record import Journal
from hexdbb.trajectory import Table, plan_programme

PARTS = 10
"""Looks at the memory during a run."""


class Forgotten(list[tuple[int, bytes]]):
    """Sent frames of the scripted bus, which itself must not grow."""

    def append(self, frame: tuple[int, bytes]) -> None:
        """Forget the frame."""


def resident_mb() -> float:
    """Return the memory of this process, MB."""
    (pages,) = (line.split()[1] for line in Path("/proc/self/status").read_text().splitlines() if "VmRSS" in line)
    return int(pages) / 1024.0


def memory_of(cycles: int) -> Iterator[tuple[int, float]]:
    """Yield the number of cycles so far and the memory (MB): a tenth of them at a time, journal and checks included."""
    plan = load_plan("thesis")
    laps = max(1, round(cycles * CYCLE_S / 60.0))
    plan = plan.model_copy(update={"laps": laps, "directions": (1,)})
    machine = plan.machine_file()
    programme = plan_programme(plan, machine, CYCLE_S, "thesis")
    start_mm = programme.part(0, 1).sliders_mm

    def from_zero(first: int, last: int) -> Table:
        """Return targets that begin where the axes of the scripted bus stand."""
        table = programme.part(first, last)
        return replace(table, sliders_mm=table.sliders_mm - start_mm)

    bus, looks = ScriptedBus(), list[tuple[int, float]]()
    bus.sent = Forgotten()
    axes = axes_on(bus)
    axes.read_positions()
    with tempfile.TemporaryDirectory() as folder:
        made = {"machine": machine, "gauge": plan.gauge, "mounts": plan.mounts, "circles": plan.circles}
        with (
            Journal(Path(folder) / "run.parquet", may_wait=True, **made) as journal,
            TargetsAhead(from_zero, len(programme), 1000.0) as targets,
        ):
            axes.enable()
            targets.begin()
            samples = SampleBuffer(programme, journal, 1000.0)
            kept = CapturedRows(samples, axes._loop, RunProgress())

            def counted() -> Iterator[Row]:
                for row in targets:
                    if row.index % max(1, cycles // PARTS) == 0:
                        looks.append((row.index, resident_mb()))
                    if row.index >= cycles:
                        return
                    yield row

            axes.follow(counted(), kept, {})
            looks.append((cycles, resident_mb()))
    yield from looks
