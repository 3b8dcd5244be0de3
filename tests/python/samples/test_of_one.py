"""The state of one slider, on which the gauge's reading may depend."""

from __future__ import annotations

import numpy as np

from hexdbb.learned import Learned
from hexdbb.record import Record
from hexdbb.samples import Samples


def test_it_is_the_column_of_that_slider(record: Record) -> None:
    samples = Samples.of([record])
    assert np.array_equal(samples["velocity_mm_s.of@4"], samples["velocity_mm_s"][:, 3])


def test_a_reading_may_follow_every_drive() -> None:
    for slider in range(1, 7):
        found = Learned.parse(f"learned:reading:slider_{slider}_acceleration")
        assert found.variable.column == f"acceleration_mm_s2.of@{slider}"
        assert found.variable.words == f"acceleration of slider {slider}"
        assert found.variable.needs == {"acceleration_mm_s2", "time_s"}
