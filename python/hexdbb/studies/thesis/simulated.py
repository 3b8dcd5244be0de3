"""Simulated record of the thesis' circular test on a machine with known errors: clockwise, then counter-clockwise.

The engine computes the readings; normal noise is added and the sum rounded to the gauge's resolution. It tests
estimators against each other; `hexdbb-run` on the simulated rig makes records whose truth shares no code with the
engine.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hexdbb.machine import MachineFile
from hexdbb.plan import Circle, Gauge, Mount
from hexdbb.record import SLIDER_COLUMNS, Record
from hexdbb.studies.thesis.circular_test import SAMPLES, circle_test

Floats = NDArray[np.float64]

FEED_MM_MIN = 753.98
"""Feed of the thesis, section 4-3, mm/min."""
GAUGE_NOISE_UM = 0.5
RESOLUTION_UM = 0.1
"""Gauge specification of the shipped plans."""


def simulated_record(
    machine: MachineFile, circle: Circle, mount: Mount, bar_length_mm: float, values: Floats, seed: int
) -> Record:
    """Return a simulated record of one lap in each direction.

    Parameters
    ----------
    machine, circle, mount, bar_length_mm
        As `circle_test`.
    values : ndarray, shape (len(UNKNOWNS),)
        The machine's errors, mm and rad.
    seed : int
        Seed of the noise.

    Raises
    ------
    InputError
        The circle is out of reach, with or without the errors.
    """
    test = circle_test(machine, circle, mount, bar_length_mm)
    one_way = test.nominal_mm + test.contour_mm(values)
    forward = np.arange(SAMPLES)
    order = np.concatenate([forward[::-1], forward])
    direction = np.repeat([-1, 1], SAMPLES)
    noise_um = np.random.default_rng(seed).normal(0.0, GAUGE_NOISE_UM, 2 * SAMPLES)
    reading_um = np.round((one_way[order] * 1e3 + noise_um) / RESOLUTION_UM) * RESOLUTION_UM
    step_s = circle.radius_mm * 2.0 * np.pi / SAMPLES / (FEED_MM_MIN / 60.0)
    columns = {
        "t_s": np.arange(2 * SAMPLES) * step_s,
        "circle": np.full(2 * SAMPLES, circle.id),
        "sweep": np.repeat([0, 1], SAMPLES),
        "direction": direction,
        "lap": np.zeros(2 * SAMPLES),
        "angle_deg": np.degrees(test.angle_rad)[order],
        "feed_mm_min": np.full(2 * SAMPLES, FEED_MM_MIN),
        **dict(zip(SLIDER_COLUMNS, test.sliders_mm[order].T, strict=True)),
        "reading_um": reading_um,
    }
    gauge = Gauge(bar_length_mm=bar_length_mm, noise_um=GAUGE_NOISE_UM, resolution_um=RESOLUTION_UM)
    return Record(columns, gauge, (mount,), (circle,), machine, {"simulated": "by the engine"})
