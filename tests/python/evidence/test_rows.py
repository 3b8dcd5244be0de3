"""Blocks of readings whose mean stands for them: as long as rows must be few, and as no effect changes within."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.evidence.linear.rows import blocks_of, means_of, middles_of

ROWS, LEAD_MM = 4000, 10.0


def blocks(step_mm: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Blocks of four readings, of which the third slider alone moves, and the positions."""
    sliders_mm = np.zeros((ROWS, 6))
    sliders_mm[:, 2] = step_mm * np.arange(ROWS)
    begin, count = blocks_of(np.arange(ROWS) // 1000, ROWS // 4)
    assert set(count) == {4}
    return *middles_of(begin, count, sliders_mm, 0.1 * LEAD_MM), sliders_mm[:, 2]


@pytest.mark.parametrize(("step_mm", "length"), [(0.0, 4), (0.2, 4), (0.4, 2), (0.8, 1), (3.0, 1)])
def test_blocks_are_as_long_as_a_tenth_of_a_turn(step_mm: float, length: int) -> None:
    _, count, _ = blocks(step_mm)
    assert len(count) == ROWS // 4
    assert set(count) == {length}


@pytest.mark.parametrize("step_mm", [0.1, 0.24, 0.45, 1.7, 2.4])
def test_a_pitch_error_is_in_the_means_as_it_is_in_their_middles(step_mm: float) -> None:
    begin, count, position_mm = blocks(step_mm)
    pitch = np.sin(2.0 * np.pi * position_mm / LEAD_MM)
    middle_mm = means_of(position_mm, begin, count)
    left = means_of(pitch, begin, count) - np.sin(2.0 * np.pi * middle_mm / LEAD_MM)
    assert np.sqrt(np.mean(left**2)) < 0.02 * np.sqrt(0.5)


def test_blocks_stay_within_their_sweeps() -> None:
    begin, count = blocks_of(np.repeat([0, 1, 2], [50, 7, 43]), 30)
    sweep = np.repeat([0, 1, 2], [50, 7, 43])
    assert all(len(set(sweep[first : first + length])) == 1 for first, length in zip(begin, count, strict=True))
    assert count.sum() == 100
