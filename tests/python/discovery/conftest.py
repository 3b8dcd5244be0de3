"""Cases of the truth simulator, measured once for all tests of discovery, at half the usual pace."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest

from hexdbb.discovery import Discovery, discover
from hexdbb.model import new_model
from hexdbb.record import Record
from hexdbb.samples import Samples
from hexdbb_truth.cases import case
from hexdbb_truth.plans import PACE

Measured = Callable[[str], Record]


@lru_cache
def _measured(name: str) -> Record:
    return case(name, replace(PACE, rate_hz=0.5 * PACE.rate_hz)).record()


@pytest.fixture(scope="session")
def measured() -> Measured:
    """Return the record of a case, by its name."""
    return _measured


@pytest.fixture(scope="session")
def few(measured: Measured) -> Record:
    """Return every eighth sample of a machine without a fault: enough for algebra."""
    record = measured("none-s3")
    return record.part(np.arange(len(record)) % 8 == 0)


@lru_cache
def _found(name: str) -> Discovery:
    record = _measured(name)
    return discover(Samples.of([record]), new_model(record.machine))


@pytest.fixture(scope="session")
def found_in() -> Callable[[str], Discovery]:
    """Return what is found missing from a new model on the record of a case."""
    return _found
