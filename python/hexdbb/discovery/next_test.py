"""The next best test: the circle on which two explanations of the same readings would differ most.

Two models that fit the records alike predict different readings elsewhere. Of their difference on a circle not run
yet only what the model's other values cannot make up for counts: whitened with the covariance the fit leaves them,

    power = d' (noise^2 I + J C J')^-1 d,

its root is the distance of the two explanations in standard deviations that the circle is expected to show.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis import Noise
from hexdbb.discovery.result import NextTest
from hexdbb.errors import InputError
from hexdbb.kinematics import inverse
from hexdbb.model import Model
from hexdbb.plan import Circle
from hexdbb.record import Record
from hexdbb.samples import Samples, linearise, normal_equations, predict

Floats = NDArray[np.float64]

SAMPLES_PER_LAP = 120
READINGS_PER_SAMPLE = 10.0
"""A real lap has at least ten times the readings tried here."""
RADIUS_STEPS = (0.0, 0.995, -0.995)
"""Off the nominal radius by this part of the gauge's range."""
TILTS_DEG = (-12.0, 0.0, 12.0)
YAWS_DEG = (-15.0, 0.0, 15.0)
FEEDS_MM_MIN = (300.0, 1000.0, 3000.0)


def next_test(samples: Samples, noise: Noise, models: tuple[Model, Model], names: tuple[str, str]) -> NextTest | None:
    """Find the circle that tells two explanations apart best.

    Parameters
    ----------
    samples : Samples
        That both explain.
    noise : Noise
        Of one reading.
    models : tuple of two Models
        Fitted to the samples.
    names : tuple of two str
        What they are called.

    Returns
    -------
    NextTest or None
        None where no circle in reach shows a difference of a standard deviation.
    """
    found: NextTest | None = None
    like = samples.records[0]
    free = np.flatnonzero(models[0].free)
    prior = models[0].prior_sigma[free]
    information = normal_equations(samples, models[0]).information[np.ix_(free, free)] / noise.sigma_mm**2
    information = information + np.diag(prior**-2.0)
    for circle, feed in _circles(like):
        record = _imagined(like, circle, feed)
        if record is None:
            continue
        sigmas = _difference(noise, record, models, information)
        if sigmas > max(1.0, 0.0 if found is None else found.expected_sigmas):
            found = NextTest(circle, feed, sigmas, names)
    return found


def _circles(like: Record) -> Iterator[tuple[Circle, float]]:
    first = like.circles[0]
    number = max(circle.id for circle in like.circles) + 1
    range_mm = like.gauge.range_um / 1000.0
    poses = [(roll, pitch, 0.0) for roll, pitch in itertools.product(TILTS_DEG, TILTS_DEG) if not (roll and pitch)]
    poses += [(0.0, 0.0, yaw) for yaw in YAWS_DEG if yaw]
    for step, rpy, plane, feed in itertools.product(
        RADIUS_STEPS, poses, ((0.0, 0.0, 0.0), (8.0, 0.0, 0.0)), FEEDS_MM_MIN
    ):
        radius_mm = like.gauge.bar_length_mm + 0.5 * step * range_mm
        changes = {"id": number, "radius_mm": radius_mm, "platform_rpy_deg": rpy, "plane_rpy_deg": plane}
        yield first.model_copy(update=changes), feed


def _imagined(like: Record, circle: Circle, feed_mm_min: float) -> Record | None:
    """Return the record of a lap each way, readings zero; None where the circle is out of reach."""
    count = 2 * SAMPLES_PER_LAP
    turn = np.arange(SAMPLES_PER_LAP) / SAMPLES_PER_LAP
    angle = 2.0 * np.pi * np.concatenate([turn, -turn])
    cup = like.mount(circle.mount).cup_mm
    sliders, status = inverse(like.machine, circle.poses(angle, cup), circle.platform_rpy_rad)
    if status.any():
        return None
    lap_s = 2.0 * np.pi * circle.radius_mm / (feed_mm_min / 60.0)
    columns: dict[str, NDArray[np.generic]] = {
        "t_s": np.concatenate([turn, turn + 1.5]) * lap_s,
        "circle": np.full(count, circle.id),
        "sweep": np.repeat([0, 1], SAMPLES_PER_LAP),
        "direction": np.repeat([1, -1], SAMPLES_PER_LAP),
        "lap": np.zeros(count, dtype=int),
        "angle_deg": np.degrees(angle),
        "feed_mm_min": np.full(count, feed_mm_min),
        "reading_um": np.zeros(count),
    }
    columns |= {f"s{k + 1}_mm": sliders[:, k] for k in range(6)}
    if "temperature_c" in like.columns:
        columns["temperature_c"] = np.full(count, float(np.mean(like.columns["temperature_c"])))
    return replace(like, columns=columns, circles=(*like.circles, circle), path=None, whole_hash=like.content_hash())


def _difference(noise: Noise, record: Record, models: tuple[Model, Model], information: Floats) -> float:
    """Distance of two models' readings in sigmas; `information` is what the records tell of the first's values."""
    first, second = models
    try:
        samples = Samples.of([record])
        one, other = linearise(samples, first), predict(samples, second)
    except (ValueError, InputError):  # no pose, a state that an effect needs, or a user's effect that fails there
        return 0.0
    difference: Floats = one.reading_mm - other.reading_mm
    sigma_mm = noise.sigma_mm / np.sqrt(READINGS_PER_SAMPLE)
    jacobian = one.jacobian[:, np.flatnonzero(first.free)]
    explained = jacobian.T @ difference / sigma_mm**2
    inner = information + jacobian.T @ jacobian / sigma_mm**2
    power = float(difference @ difference) / sigma_mm**2 - float(explained @ np.linalg.solve(inner, explained))
    return float(np.sqrt(max(power, 0.0)))
