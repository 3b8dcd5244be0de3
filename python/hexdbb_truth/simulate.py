"""A plan driven on a true machine, without a bus: the record that `hexdbb-run` would have written.

Model: mechanisms go through every instant of the time line; poses are solved at the samples, all of a run at once; the
gauge adds white noise and rounds to its resolution, encoders round to their counts.
Assumption: errors of geometry and set-up are in the truth; `random_truth` has them always.
Units: as in the columns' names.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.machine import MachineFile
from hexdbb.plan import Plan
from hexdbb.record import SLIDER_COLUMNS, Record
from hexdbb.rig.geometry import Array
from hexdbb.rig.mechanisms import Push
from hexdbb.rig.plant import Machine
from hexdbb.rig.truth import GaugeTruth, TruthFile
from hexdbb_truth.timeline import Arc, Drive, Timeline

RATE_HZ = 12.0
"""About 10,000 samples on the discovery plan; the mains' 50 Hz is no multiple of it."""
INSTANTS_PER_SAMPLE = 20
"""One instant each 4 ms, as the rig's cycle."""
TRAVEL_S = 10.0
ROOM_C = 20.0
SENSOR_NOISE_C = 0.02


@dataclass(frozen=True)
class Pace:
    """How finely time is cut: samples per second, instants per sample, time from run to run in s."""

    rate_hz: float = RATE_HZ
    instants_per_sample: int = INSTANTS_PER_SAMPLE
    travel_s: float = TRAVEL_S


def simulate(
    truth: TruthFile,
    plan: Plan,
    seed: int | None = None,
    pace: Pace | None = None,
    temperature: bool = False,
    drive: Drive | None = None,
) -> Record:
    """Drive a plan on a true machine.

    Parameters
    ----------
    truth : TruthFile
        What the machine really is.
    plan : Plan
        What is driven.
    seed : int, optional
        Of the noise; the truth's own where none is given.
    pace : Pace, optional
        How finely time is cut. Where no mechanism has a memory, instants between samples are left out: they change
        nothing.
    temperature : bool
        Whether a thermometer is read.
    drive : callable, optional
        Slider targets of poses, where a controller compensates.

    Returns
    -------
    Record
        `.columns` has the samples. `write_record(record, path)` writes it, the text form where `path` ends in ``.csv``.

    Raises
    ------
    InputError
        A reading is beyond the gauge's range.
    RunError
        The machine has no pose somewhere.
    """
    pace = pace if pace is not None else Pace()
    machine = plan.machine_file()
    noise_seed = truth.seed if seed is None else seed
    parts = []
    for arc, push, reading_mm in _runs(truth, plan, machine, pace, drive):
        draw = np.random.default_rng([noise_seed, arc.run.sweep])
        columns = _columns(arc, machine)
        noisy_um = reading_mm * 1e3 + draw.normal(0.0, truth.gauge.noise_um, len(reading_mm))
        columns["reading_um"] = _shown_um(noisy_um, truth.gauge, arc.run.sweep)
        if temperature:
            columns["temperature_c"] = ROOM_C + push.temperature_c + draw.normal(0.0, SENSOR_NOISE_C, len(reading_mm))
        parts.append(columns)
    joined = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    return Record(joined, plan.gauge, plan.mounts, plan.circles, machine)


def true_readings_mm(truth: TruthFile, plan: Plan, pace: Pace | None = None) -> Array:
    """Return the readings of all samples before noise and rounding, shape (n,); see `simulate`."""
    machine, pace = plan.machine_file(), pace if pace is not None else Pace()
    return np.concatenate([reading_mm for _, _, reading_mm in _runs(truth, plan, machine, pace)])


def _runs(
    truth: TruthFile, plan: Plan, machine: MachineFile, pace: Pace, drive: Drive | None = None
) -> Iterator[tuple[Arc, Push, Array]]:
    """Go through the time line; give each run with the displacements at its samples and its true readings (mm)."""
    true_machine = truth.true_machine(machine)
    remembers = any(table.has_memory for table in truth.mechanism)
    instants = pace.instants_per_sample if remembers else 1
    for stretch in Timeline(plan, machine, pace.rate_hz, instants, pace.travel_s, drive).stretches():
        if isinstance(stretch, Arc):
            push = true_machine.displaced(stretch.motion)
            yield stretch, push.at(stretch.samples), _read_mm(true_machine, stretch, push)
        else:
            true_machine.displaced(stretch)


def _read_mm(machine: Machine, arc: Arc, push: Push) -> Array:
    """Read the gauge at the samples, or so much later as it is read later, linear between instants."""
    later = push.delay_s / arc.motion.dt_s
    whole = math.floor(later)
    first = _reading_at(machine, arc, push, arc.samples + whole)
    if later == whole:
        return first
    return first + (later - whole) * (_reading_at(machine, arc, push, arc.samples + whole + 1) - first)


def _reading_at(machine: Machine, arc: Arc, push: Push, instants: NDArray[np.intp]) -> Array:
    if instants[0] < 0 or instants[-1] >= len(arc.angle_rad):
        raise InputError(f"sweep {arc.run.sweep}: the gauge is read outside the run (expected a longer overshoot)")
    there = push.at(instants)
    nominal = arc.nominal.at(instants)
    poses = machine.poses(arc.motion.drive_mm[instants], there, nominal)
    return machine.reading_mm(arc.mounted, there, poses)


def _columns(arc: Arc, machine: MachineFile) -> dict[str, NDArray[Any]]:
    """Return what is known of a run's samples without the gauge."""
    run, n = arc.run, len(arc.samples)
    turned = np.abs(arc.angle_rad[arc.samples]) / (2.0 * math.pi)
    counts = machine.can_setup.counts_per_mm
    encoders_mm = np.round(arc.motion.drive_mm[arc.samples] * counts) / counts
    return {
        "t_s": arc.motion.time_s[arc.samples],
        "circle": np.full(n, run.circle.id),
        "sweep": np.full(n, run.sweep),
        "direction": np.full(n, run.direction),
        # A sample that falls on the end of a lap belongs to the next; rounding must not decide.
        "lap": np.floor(turned + 1e-9).astype(np.int64),
        "angle_deg": np.degrees(arc.angle_rad[arc.samples]) % 360.0 % 360.0,
        "feed_mm_min": np.full(n, run.feed_mm_min),
        **dict(zip(SLIDER_COLUMNS, encoders_mm.T, strict=True)),
    }


def _shown_um(reading_um: Array, gauge: GaugeTruth, sweep: int) -> Array:
    largest = float(np.abs(reading_um).max())
    if largest > gauge.range_um:
        raise InputError(f"sweep {sweep}: reading of {largest:.0f} µm (expected within {gauge.range_um:g} µm)")
    step = gauge.resolution_um
    shown: Array = np.round(reading_um / step) * step if step > 0.0 else reading_um
    return shown
