"""A run of the soak is put down to this computer by what happened at the time of its fault, not elsewhere in it."""

from __future__ import annotations

import numpy as np
import pytest
from tests.faults.soak import STOPS, Soaked, page

LATE_S = 0.05


def soaked(message: str, late_at_s: float | None, lines: tuple[tuple[float, str], ...], rate_hz: int = 50) -> Soaked:
    """A run of 10 s in which a sleeping thread was late once."""
    woken = np.array(
        [(0.1 * k, LATE_S if late_at_s is not None and k == round(10 * late_at_s) else 1e-4) for k in range(100)]
    )
    return Soaked(rate_hz, 1, message, 0, 0, woken, lines)


@pytest.mark.parametrize(("late_at_s", "explained"), [(7.9, True), (3.0, False), (9.5, False), (None, False)])
def test_only_lateness_at_the_time_of_the_fault_explains_it(late_at_s: float | None, explained: bool) -> None:
    run = soaked("bus: no node answered 3", late_at_s, ((8.0, STOPS), (8.5, "error: bus: no node answered 3")))
    assert run.is_explained == explained
    runs = page([run, soaked("x", 7.9, ((8.0, STOPS),), 250)], 1, 0.0, 0.0).rpartition("## Runs")[2]
    assert ("**unexplained**" in runs) != explained


@pytest.mark.parametrize(("lost", "explained"), [(6, True), (7, False)])
def test_a_delay_explains_as_many_missing_samples_as_it_costs(lost: int, explained: bool) -> None:
    message = f"{lost} of 209 planned samples are missing"
    run = soaked(message, 5.0, ((2.0, "arc  reading +1 µm, 20.0 ms/cycle, 0 missed"), (9.0, f"error: {message}")))
    assert run.is_short
    assert run.is_explained == explained
