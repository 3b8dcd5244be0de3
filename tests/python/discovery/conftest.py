"""Cases of the truth simulator, measured once for all tests of discovery, at half the usual pace."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from tests.truth.cases import case
from tests.truth.plans import PACE

from hexdbb.record import Record

Measured = Callable[[str], Record]


@lru_cache
def _measured(name: str) -> Record:
    return case(name, replace(PACE, rate_hz=0.5 * PACE.rate_hz)).record()


@pytest.fixture(scope="session")
def measured() -> Measured:
    """Give the record of a case, by its name."""
    return _measured


@pytest.fixture(scope="session")
def few(measured: Measured) -> Record:
    """Give every eighth sample of a machine without a fault: enough for algebra."""
    record = measured("none-s3")
    return record.part(np.arange(len(record)) % 8 == 0)
