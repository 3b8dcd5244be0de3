"""How many fits run at once."""

from __future__ import annotations

import os

import pytest

from hexdbb.threads import fits_at_once


@pytest.mark.parametrize(("stated", "expected"), [("1", 1), ("100000", None), ("", None), ("0", None), ("4,2", None)])
def test_a_worker_fits_one_at_a_time(stated: str, expected: int | None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", stated)
    assert fits_at_once() == (expected or len(os.sched_getaffinity(0)))
