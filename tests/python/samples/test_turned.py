"""The angle turned since a circle began: with its sign, through laps, from zero in every sweep."""

from __future__ import annotations

import numpy as np

from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case


def test_it_counts_every_lap_and_the_sense_from_the_beginning_of_each_sweep() -> None:
    samples = Samples.of([case("none-calibrate-s1").record()])
    turned, sweep = samples["turned_rad"], samples["sweep"]
    directions = set()
    for each in np.unique(sweep):
        rows = np.flatnonzero(sweep == each)
        (direction,) = set(samples["direction"][rows])
        laps = 1 + int(np.ptp(samples["lap"][rows]))
        assert turned[rows[0]] == 0.0
        assert (np.diff(turned[rows]) * direction > 0.0).all()
        assert abs(abs(turned[rows[-1]]) - 2.0 * np.pi * laps) < 0.2
        # The polar angle is where it began, and what has been turned since.
        away = turned[rows] - (samples["angle_rad"][rows] - samples["angle_rad"][rows[0]])
        assert np.abs(np.sin(0.5 * away)).max() < 1e-9
        directions.add(direction)
    assert directions == {-1.0, 1.0}
