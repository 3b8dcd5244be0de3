"""The state of samples as a user's effect sees it: arrays with their units in their names."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.kinematics import forward
from hexdbb.machine import MachineFile

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]


@dataclass(frozen=True)
class SampleState:
    """State of n samples; columns of sliders and legs have shape (n, 6), all others (n,) unless said otherwise."""

    machine: MachineFile
    sliders_mm: Floats
    """Slider coordinates as the encoders report them."""
    velocity_mm_s: Floats
    travel_direction: Floats
    """+1 or -1: the direction in which each slider last moved; 0 where it never moved."""
    since_reversal_s: Floats
    """Time since each slider last reversed in its sweep; 1e6 where it has not."""
    since_reversal_mm: Floats
    """Travel since then; 1e6 where it has not."""
    leg_force: Floats
    """Axial force in each leg per newton of load at the platform's reference point, tension positive."""
    time_s: Floats
    """Since the record's first sample."""
    circle: Ints
    """Id of the circle in the plan."""
    sweep: Ints
    lap: Ints
    direction: Floats
    """+1 counter-clockwise, -1 clockwise."""
    angle_rad: Floats
    """Commanded polar angle."""
    feed_mm_s: Floats
    temperature_c: Floats
    """nan where not measured."""
    warming_k: Floats
    """Temperature minus the record's first one; nan where not measured."""
    nominal_reading_mm: Floats
    """Reading of the nominal machine."""
    position_mm: Floats
    """Platform's reference point of the nominal machine, shape (n, 3)."""
    rotation: Floats
    """Orientation of the platform, shape (n, 3, 3)."""

    def __len__(self) -> int:
        return len(self.sliders_mm)


def sample_state(samples: _core.Samples, machine: MachineFile) -> SampleState:
    """Give the state of samples, whose columns must all be there (`hexdbb.prediction.samples_of` fills them)."""
    known = samples.state
    sliders_mm = samples.sliders_mm
    _, rotation, _ = forward(machine, sliders_mm)
    columns = {each.name: known[each.name] for each in fields(SampleState) if each.name in known}
    return SampleState(machine=machine, sliders_mm=sliders_mm, rotation=rotation, **columns)
