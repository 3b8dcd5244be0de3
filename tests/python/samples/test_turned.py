"""The angle turned since a circle began, and since a fixing: with its sign, through laps."""

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


def test_what_is_wound_up_is_unwound_the_other_way_round() -> None:
    samples = Samples.of([case("none-calibrate-s1").record()])
    wound, turned, sweep, mount = (samples[each] for each in ("wound_rad", "turned_rad", "sweep", "mount"))
    for each in np.unique(mount):
        rows = np.flatnonzero(mount == each)
        assert wound[rows[0]] == 0.0
        for one in np.unique(sweep[rows]):
            own = rows[sweep[rows] == one]
            # Within a sweep it goes as what is turned in it does; from one to the next it goes on where it was.
            assert np.allclose(wound[own] - wound[own[0]], turned[own])
        assert np.abs(np.diff(wound[rows])).max() < np.pi
    assert np.ptp(wound) > 1.5 * np.pi


def test_with_one_sweep_of_each_fixing_it_would_be_what_is_turned() -> None:
    record = case("none-calibrate-s1").record()
    sweep = Samples.of([record])["sweep"]
    one = Samples.of([record.part(sweep == sweep[0])])
    assert np.isnan(one["wound_rad"]).all()
    assert np.ptp(one["turned_rad"]) > 1.5 * np.pi
