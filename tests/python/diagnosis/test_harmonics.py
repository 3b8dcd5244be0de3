"""Harmonics of captures take what a Fourier series of the angle takes, and readings are compared within a capture."""

import numpy as np
import pytest

from hexdbb import _core


def series(angle_rad: np.ndarray, highest: int) -> np.ndarray:
    multiples = np.outer(angle_rad, np.arange(highest + 1))
    return np.hstack([np.cos(multiples), np.sin(multiples[:, 1:])])


@pytest.mark.parametrize(("turns", "highest"), [(2.0, 8), (1.0, 3), (0.6, 2), (1.0, 0)])
def test_residual_is_that_of_least_squares(turns: float, highest: int) -> None:
    random = np.random.default_rng(4)
    angle_rad = np.sort(random.uniform(0.0, 2.0 * np.pi * turns, 500))
    columns = series(angle_rad, highest)
    values = columns @ random.normal(size=columns.shape[1]) + 0.01 * random.normal(size=500)
    taken, left = _core.CaptureHarmonics(angle_rad, [np.arange(500)], highest).split(values)
    assert taken.shape == (1, 2 * highest + 1)
    expected = values - columns @ np.linalg.lstsq(columns, values, rcond=None)[0]
    np.testing.assert_allclose(left, expected, atol=1e-6)
    # Components along orthonormal columns: no square is lost.
    assert np.sum(taken**2) + left @ left == pytest.approx(values @ values, rel=1e-6)


def test_captures_are_apart() -> None:
    random = np.random.default_rng(5)
    angle_rad, values = random.uniform(-9.0, 9.0, 300), random.normal(size=300)
    captures = [np.arange(0, 200, 2), np.arange(250, 120, -1)]
    taken, left = _core.CaptureHarmonics(angle_rad, captures, 3).split(values)
    for number, rows in enumerate(captures):
        alone = _core.CaptureHarmonics(angle_rad[rows], [np.arange(len(rows))], 3)
        own_taken, own_left = alone.split(values[rows])
        np.testing.assert_array_equal(taken[number], own_taken[0])
        if number == 1:  # the last of two that share rows
            np.testing.assert_array_equal(left[rows], own_left)
    assert not left[251:].any()


@pytest.mark.parametrize("row", [-1, 10])
def test_a_row_that_is_not_there_is_refused(row: int) -> None:
    angle_rad, captures = np.zeros(10), [np.array([0, row])]
    with pytest.raises(ValueError, match=r"a row that is not there, expected 0 to 9"):
        _core.CaptureHarmonics(angle_rad, captures, 1)
    with pytest.raises(ValueError, match=r"a row that is not there"):
        _core.mean_paths(angle_rad, angle_rad, np.zeros(10, np.int64), captures, 1.0)
    with pytest.raises(ValueError, match=r"a row that is not there"):
        _core.lap_differences(angle_rad, np.zeros(10, np.int64), angle_rad, captures, [1])


def test_no_reading_has_its_neighbour_in_another_capture() -> None:
    """Two captures that differ by a step: neither reading beside the step stands alone."""
    angle_rad = np.tile(np.linspace(0.0, 6.0, 100), 2)
    values = np.repeat([0.0, 1.0], 100) + 0.01 * np.sin(np.arange(200.0) ** 2)
    values[[30, 150]] += 0.5
    captures = [np.arange(100), np.arange(100, 200)]
    off, alone = _core.compare_with_neighbours(
        angle_rad, values, captures, 0.01, neighbours=3, dense_rad=0.1, doubtful=3.0, alone=6.0
    )
    assert np.flatnonzero(alone).tolist() == [30, 150]
    assert np.all(np.abs(off[[0, 99, 100, 199]]) < 3.0)
    sparse = _core.compare_with_neighbours(
        angle_rad, values, captures, 0.01, neighbours=3, dense_rad=0.05, doubtful=3.0, alone=6.0
    )
    assert not sparse[1].any()
