"""What several test modules share: a small valid record, made of the shipped thesis plan without the engine."""

from __future__ import annotations

import resource
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager

import numpy as np
import pytest
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from hexdbb.plan import load_plan
from hexdbb.record import SLIDER_COLUMNS, Record

SAMPLES_PER_SWEEP = 25


@pytest.fixture(scope="session", autouse=True)
def one_thread() -> Iterator[None]:
    """As commands and `hexdbb`'s functions have it; tests of what is behind these would take several times as long."""
    with threadpool_limits(1, "blas"):
        yield


@pytest.fixture
def columns() -> dict[str, NDArray[np.float64]]:
    """Two sweeps, clockwise and counter-clockwise; every value is within its limits, nothing is kinematically true."""
    count = 2 * SAMPLES_PER_SWEEP
    rng = np.random.default_rng(20)
    second = np.arange(count) >= SAMPLES_PER_SWEEP
    sliders = {name: rng.uniform(20.0, 846.0, count) for name in SLIDER_COLUMNS}
    return {
        "t_s": np.arange(count) * 0.004,
        "circle": np.zeros(count),
        "sweep": second.astype(float),
        "direction": np.where(second, 1.0, -1.0),
        "lap": np.zeros(count),
        "angle_deg": rng.uniform(-720.0, 720.0, count),
        "feed_mm_min": np.full(count, 753.98),
        **sliders,
        "reading_um": rng.normal(0.0, 10.0, count),
    }


@pytest.fixture
def record(columns: dict[str, NDArray[np.float64]]) -> Record:
    plan = load_plan("thesis")
    return Record(columns, plan.gauge, plan.mounts, plan.circles, plan.machine_file(), {"can": {"bus": "none"}})


@pytest.fixture
def disk_full_after() -> Callable[[int], AbstractContextManager[None]]:
    """Let no file grow beyond a number of bytes, as a full disk would (the system's own limit; EFBIG for ENOSPC)."""

    @contextmanager
    def limited(count: int) -> Iterator[None]:
        soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (count, hard))
        try:
            yield
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))

    return limited
