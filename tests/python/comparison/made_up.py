"""Made-up circles: any deviation as a function of angle, any circles, feeds, directions and laps; any prediction."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from hexdbb.comparison import Comparison, compare_readings
from hexdbb.machine import shipped_machine
from hexdbb.plan import Circle, Gauge, Mount
from hexdbb.record import Record
from hexdbb.samples import Samples

SAMPLES_PER_LAP = 720

Deviation = Callable[[np.ndarray, int], np.ndarray]
"""Deviation in mm of angle (rad) and direction."""
MakeRecord = Callable[..., Record]


def compared(records: Sequence[Record], predicted_mm: Sequence[np.ndarray]) -> Comparison:
    """Compare records with a prediction for each."""
    return compare_readings(Samples.of(records), np.concatenate(predicted_mm))


def made_record(
    deviation_mm: Deviation,
    circles: int = 1,
    feeds: tuple[float, ...] = (753.98,),
    directions: tuple[int, ...] = (1, -1),
    laps: int = 1,
    radius_mm: float = 100.0,
    path: Path | None = Path("demo.parquet"),
) -> Record:
    turn_deg = np.arange(SAMPLES_PER_LAP) * 360.0 / SAMPLES_PER_LAP
    captures = [(c, f, d) for c in range(circles) for f in feeds for d in directions]
    blocks = []
    for sweep, (circle, feed, direction) in enumerate(captures):
        for lap in range(laps):
            angle_deg = np.mod(direction * turn_deg, 360.0)
            reading_um = 1e3 * deviation_mm(np.radians(angle_deg), direction)
            block = np.broadcast_arrays(circle, sweep, direction, lap, angle_deg, feed, reading_um)
            blocks.append(np.column_stack(block))
    names = ("circle", "sweep", "direction", "lap", "angle_deg", "feed_mm_min", "reading_um")
    columns = dict(zip(names, np.concatenate(blocks).T, strict=True))
    columns["t_s"] = 0.004 * np.arange(len(columns["circle"]))
    columns |= {f"s{k}_mm": np.full(len(columns["t_s"]), 100.0 * k) for k in range(1, 7)}
    return Record(
        columns=columns,
        gauge=Gauge(bar_length_mm=100.0),
        mounts=(Mount(id=0, cup_mm=(0.0, 0.0, 340.0)),),
        circles=tuple(
            Circle(
                id=identity,
                mount=0,
                radius_mm=radius_mm,
                ball_offset_mm=(0.0, 0.0, 60.0),
                platform_rpy_deg=(-4.0 * identity, 0.0, 0.0),
            )
            for identity in range(circles)
        ),
        machine=shipped_machine(),
        path=path,
    )
