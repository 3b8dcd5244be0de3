"""Records of made-up circles."""

from __future__ import annotations

import pytest
from tests.python.comparison.made_up import MakeRecord, made_record


@pytest.fixture
def make_record() -> MakeRecord:
    return made_record
