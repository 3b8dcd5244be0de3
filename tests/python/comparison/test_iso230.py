"""Circle fits and ISO 230-4 quantities against closed forms, invariances and an independent search."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog, minimize

from hexdbb.comparison import iso230
from hexdbb.comparison.circle_fit import least_squares_circle, minimum_zone
from hexdbb.errors import InputError

RADIUS_MM = 100.0
ANGLES = iso230.even_angles(720)

harmonics_mm = st.lists(
    st.tuples(st.integers(0, 12), st.floats(-0.02, 0.02), st.floats(0.0, 2.0 * np.pi)), min_size=1, max_size=5
)
shift_mm = st.floats(-0.1, 0.1)


def path_of(deviation_mm: np.ndarray, angle_rad: np.ndarray = ANGLES) -> iso230.Path:
    return iso230.make_path(angle_rad, deviation_mm, RADIUS_MM)


def offset_circle(x_mm: float, y_mm: float, radius_mm: float) -> np.ndarray:
    """Deviation at polar angles ANGLES of an exact circle of `radius_mm` about (x, y)."""
    along = x_mm * np.cos(ANGLES) + y_mm * np.sin(ANGLES)
    across = x_mm * np.sin(ANGLES) - y_mm * np.cos(ANGLES)
    return along + np.sqrt(radius_mm**2 - across**2) - RADIUS_MM


def sum_of(harmonics: list[tuple[int, float, float]], angle_rad: np.ndarray = ANGLES) -> np.ndarray:
    return sum((a * np.cos(k * angle_rad + phase) for k, a, phase in harmonics), np.zeros_like(angle_rad))


def test_a_circle_off_centre_has_no_circular_deviation() -> None:
    path = path_of(offset_circle(0.3, -0.2, 100.05))
    centre = iso230.set_up_centre_mm(path)
    assert iso230.circular_deviation_mm(path) == pytest.approx(0.0, abs=1e-9)
    assert centre == pytest.approx([0.3, -0.2], abs=1e-9)
    assert iso230.mean_bidirectional_radial_deviation_mm(path, path) == pytest.approx(0.05, abs=1e-9)
    removed = iso230.radial_deviation(path, centre)
    assert (removed.max_mm, removed.min_mm) == pytest.approx((0.05, 0.05), abs=1e-9)
    kept = iso230.radial_deviation(path, None)
    assert kept.max_mm == pytest.approx(0.05 + np.hypot(0.3, 0.2), abs=1e-5)
    assert kept.min_mm == pytest.approx(0.05 - np.hypot(0.3, 0.2), abs=1e-5)


@pytest.mark.parametrize("lobes", [2, 3, 4, 7])
def test_a_lobed_shape_has_twice_its_amplitude(lobes: int) -> None:
    """With two lobes or more no shift of the centre helps, so the zone is centred: G is exactly 2 a."""
    angles = iso230.even_angles(360 * lobes)
    path = path_of(0.012 * np.cos(lobes * angles), angles)
    assert iso230.circular_deviation_mm(path) == pytest.approx(0.024, abs=1e-9)


def test_an_ellipse_has_the_difference_of_its_half_axes() -> None:
    a, b = RADIUS_MM + 0.03, RADIUS_MM - 0.01
    radius = a * b / np.hypot(b * np.cos(ANGLES), a * np.sin(ANGLES))
    assert iso230.circular_deviation_mm(path_of(radius - RADIUS_MM)) == pytest.approx(a - b, abs=1e-9)


def test_two_directions_apart_by_a_constant() -> None:
    ccw, cw = path_of(np.full(720, 0.008)), path_of(np.full(720, -0.002))
    assert iso230.circular_deviation_mm(ccw) == pytest.approx(0.0, abs=1e-9)
    assert iso230.bidirectional_circular_deviation_mm(ccw, cw) == pytest.approx(0.010, abs=1e-9)
    assert iso230.circular_hysteresis_mm(ccw, cw) == pytest.approx(0.010, abs=1e-12)
    assert iso230.mean_bidirectional_radial_deviation_mm(ccw, cw) == pytest.approx(0.003, abs=1e-9)


def test_backlash_step_gives_hysteresis_at_any_sampling() -> None:
    """A step of 6 µm over half a turn, the directions sampled at different angles."""
    other = iso230.even_angles(500) + 1e-3
    ccw = path_of(np.where(np.pi > ANGLES, 0.003, 0.0))
    cw = path_of(np.where(other < np.pi, -0.003, 0.0), other)
    assert iso230.circular_hysteresis_mm(ccw, cw) == pytest.approx(0.006, abs=1e-12)


def test_laps_are_averaged_before_evaluation() -> None:
    base = 0.01 * np.cos(3 * ANGLES)
    ripple = 0.004 * np.cos(40 * ANGLES)
    mean = iso230.mean_path([path_of(base + ripple), path_of(base - ripple)])
    assert mean.deviation_mm == pytest.approx(base, abs=1e-12)
    cut_short = path_of(np.full(100, 0.5), ANGLES[:100])
    assert iso230.mean_path([path_of(base), cut_short]).deviation_mm == pytest.approx(base)
    assert not cut_short.is_full_circle


@settings(max_examples=60, deadline=None)
@given(harmonics_mm, shift_mm, shift_mm)
def test_minimum_zone_bounds(harmonics: list[tuple[int, float, float]], x_mm: float, y_mm: float) -> None:
    deviation = sum_of(harmonics)
    points = path_of(deviation).points_mm + np.array([x_mm, y_mm])
    zone = minimum_zone(points)
    rho = np.linalg.norm(points - zone.centre_mm, axis=1)
    assert rho.min() >= zone.inner_mm - 1e-12
    assert rho.max() <= zone.outer_mm + 1e-12
    least_squares = np.linalg.norm(points - least_squares_circle(points).centre_mm, axis=1)
    assert zone.width_mm <= np.ptp(least_squares) + 1e-12
    assert zone.width_mm <= np.ptp(deviation) + 1e-9
    assert zone.width_mm <= 2.0 * sum(abs(a) for k, a, _ in harmonics if k > 0) + 1e-9


@settings(max_examples=40, deadline=None)
@given(harmonics_mm, st.floats(-10.0, 10.0))
# Seven lobes one way and none the other: steps between contacts of nearly one angle came back to where they were.
@example([(0, 0.015625, 0.0), (7, 0.015625, 3.5), (0, 0.0, 0.0)], 0.0)
def test_quantities_do_not_depend_on_the_angle_origin(
    harmonics: list[tuple[int, float, float]], turn_rad: float
) -> None:
    ccw, cw = sum_of(harmonics), sum_of(harmonics[::-1][:1])
    here = (path_of(ccw), path_of(cw))
    there = (path_of(ccw, ANGLES + turn_rad), path_of(cw, ANGLES + turn_rad))
    for quantity in (
        iso230.bidirectional_circular_deviation_mm,
        iso230.circular_hysteresis_mm,
        iso230.mean_bidirectional_radial_deviation_mm,
        lambda one, two: iso230.radial_deviation(one, iso230.set_up_centre_mm(one, two)).max_mm,
    ):
        assert quantity(*there) == pytest.approx(quantity(*here), abs=1e-9)


@settings(max_examples=40, deadline=None)
@given(harmonics_mm, harmonics_mm)
def test_both_directions_need_at_least_the_zone_of_each(
    one: list[tuple[int, float, float]], two: list[tuple[int, float, float]]
) -> None:
    ccw, cw = path_of(sum_of(one)), path_of(sum_of(two))
    both = iso230.bidirectional_circular_deviation_mm(ccw, cw)
    assert both >= max(iso230.circular_deviation_mm(ccw), iso230.circular_deviation_mm(cw)) - 1e-9
    assert both <= np.ptp(np.concatenate([ccw.deviation_mm, cw.deviation_mm])) + 1e-9


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("copies", [1, 2])
def test_minimum_zone_against_a_search_over_centres(seed: int, copies: int) -> None:
    """Noise, quantisation, uneven and repeated angles: Nelder-Mead from several starts finds nothing better."""
    rng = np.random.default_rng(seed)
    angle = np.tile(np.sort(rng.uniform(0.0, 2.0 * np.pi, 150)), copies)
    deviation = np.round(sum_of([(1, 0.03, 1.0), (2, 0.01, 0.3), (3, 0.008, seed)], angle), 4)
    points = path_of(deviation + 0.002 * rng.standard_normal(len(angle)), angle).points_mm
    zone = minimum_zone(points)

    def width_um(offset_um: np.ndarray) -> float:
        return 1e3 * float(np.ptp(np.linalg.norm(points - zone.centre_mm - 1e-3 * offset_um, axis=1)))

    options = {"xatol": 1e-8, "fatol": 1e-9, "maxiter": 2000}
    found = [minimize(width_um, rng.normal(0.0, 8.0, 2), method="Nelder-Mead", options=options).fun for _ in range(3)]
    assert 1e3 * zone.width_mm <= min(found) + 1e-6
    assert 1e3 * zone.width_mm == pytest.approx(min(found), abs=1e-3)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("count", [60, 720, 3000])
def test_minimum_zone_against_linear_programming(seed: int, count: int) -> None:
    """HiGHS on the programme linearised about the centre found promises no narrower zone, to 1e-9 µm."""
    rng = np.random.default_rng(seed)
    angle = iso230.even_angles(count)
    deviation = sum_of([(1, 0.05, 1.0), (2, 0.01, 0.3), (3, 0.004, seed)], angle) + 5e-4 * rng.standard_normal(count)
    points = path_of(deviation, angle).points_mm
    zone = minimum_zone(points)
    offset = points - zone.centre_mm
    rho = np.linalg.norm(offset, axis=1)
    along, one, none = offset / rho[:, None], np.ones((count, 1)), np.zeros((count, 1))
    # Step in x and y, outer and inner radius; all as excess over the mean radius, in units of the zone's width.
    excess = (rho - rho.mean()) / zone.width_mm
    rows = np.vstack([np.hstack([-along, -one, none]), np.hstack([along, none, one])])
    best = linprog([0.0, 0.0, 1.0, -1.0], A_ub=rows, b_ub=np.concatenate([-excess, excess]), bounds=(None, None))
    assert best.status == 0
    assert 1e3 * zone.width_mm * best.fun == pytest.approx(1e3 * zone.width_mm, abs=1e-9)


@pytest.mark.parametrize(
    ("angle", "deviation", "radius", "word"),
    [
        (np.zeros(0), np.zeros(0), 100.0, "one length"),
        (np.zeros(3), np.zeros(4), 100.0, "one length"),
        (np.zeros(3), np.array([0.0, np.nan, 0.0]), 100.0, "finite"),
        (np.zeros(3), np.zeros(3), 0.0, "positive nominal radius"),
    ],
)
def test_bad_paths_are_refused(angle: np.ndarray, deviation: np.ndarray, radius: float, word: str) -> None:
    with pytest.raises(InputError, match=word):
        iso230.make_path(angle, deviation, radius)


def test_circles_that_cannot_be_fitted_are_refused() -> None:
    line = np.column_stack([np.arange(5.0), 2.0 * np.arange(5.0)])
    with pytest.raises(InputError, match="one line"):
        least_squares_circle(line)
    with pytest.raises(InputError, match="at least 3 points"):
        minimum_zone(line[:2])
    with pytest.raises(InputError, match="4 angles"):
        minimum_zone(np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, -0.1]]))
