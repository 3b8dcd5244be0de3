"""The numbers of a report as CSV: one row a sample."""

from __future__ import annotations

import io

import numpy as np
import pyarrow as pa
import pyarrow.csv

from hexdbb.comparison import UM_PER_MM, Comparison
from hexdbb.record.arrow import array_of

DECIMALS = {"angle_deg": 4, "measured_um": 3, "predicted_um": 3, "residual_um": 3, "feed_mm_min": 3}
"""Digits kept, beyond any gauge: a nanometre, a ten-thousandth of a degree; all digits would double the file."""


def samples_csv(comparison: Comparison, record: int) -> str:
    """Return the samples of one record: circle, feed, direction, sweep, lap, angle, measured, predicted, residual."""
    samples = comparison.samples
    rows = samples["record"] == record
    part = samples.part(rows)
    columns = {
        "circle": part["circle"],
        "feed_mm_min": 60.0 * part["feed_mm_s"],
        "direction": part["direction"],
        "sweep": part["sweep"],
        "lap": part["lap"],
        "angle_deg": np.degrees(part["angle_rad"]),
        "measured_um": UM_PER_MM * part.reading_mm,
        "predicted_um": UM_PER_MM * comparison.predicted_mm[rows],
        "residual_um": UM_PER_MM * comparison.residual_mm[rows],
    }
    rounded = {name: np.round(each, DECIMALS[name]) if name in DECIMALS else each for name, each in columns.items()}
    stream = io.BytesIO()
    pyarrow.csv.write_csv(
        pa.table({name: array_of(each) for name, each in rounded.items()}),
        stream,
        pyarrow.csv.WriteOptions(quoting_style="none"),
    )
    return stream.getvalue().decode()
