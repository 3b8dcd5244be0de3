"""White noise is known for what it is; a line, a trend, a burst are not taken for it."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from hexdbb.diagnosis import is_white

SERIES, VALUES = 28, 150


def noise(seed: int) -> list[NDArray[np.float64]]:
    return list(np.random.default_rng(seed).normal(0.0, 0.5, (SERIES, VALUES)))


@pytest.mark.parametrize("seed", range(30))
def test_noise_is_white(seed: int) -> None:
    assert is_white(noise(seed))


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("kind", ["line", "trend", "burst"])
def test_what_changes_is_not(kind: str, seed: int) -> None:
    at = np.arange(VALUES)
    changes = {
        "line": [0.5 * np.sin(2.0 * at + k) for k in range(SERIES)],
        "trend": [1.5 * (at / VALUES - 0.5)] * SERIES,
        "burst": [np.random.default_rng(k).normal(0.0, 1.0, VALUES) if k == 3 else 0.0 * at for k in range(SERIES)],
    }
    assert not is_white([white + change for white, change in zip(noise(seed), changes[kind], strict=True)])


@pytest.mark.parametrize("seed", range(10))
def test_noise_may_be_larger_at_another_feed(seed: int) -> None:
    feeds = [20.0, 80.0] * (SERIES // 2)
    larger = [(3.0 if feed > 50.0 else 1.0) * each for feed, each in zip(feeds, noise(seed), strict=True)]
    assert not is_white(larger)
    assert is_white(larger, feeds)
    burst = [5.0 * each if place == 4 else each for place, each in enumerate(larger)]
    assert not is_white(burst, feeds)


def test_too_little_to_tell() -> None:
    assert not is_white([])
    assert not is_white([np.ones(10)])
    assert not is_white([np.zeros(100)])
