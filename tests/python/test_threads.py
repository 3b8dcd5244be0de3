"""How many fits run at once, and what runs beside the rest of a command."""

from __future__ import annotations

import os
import threading

import pytest

from hexdbb.threads import computed_beside, fits_at_once


@pytest.mark.parametrize(("stated", "expected"), [("1", 1), ("100000", None), ("", None), ("0", None), ("4,2", None)])
def test_a_worker_fits_one_at_a_time(stated: str, expected: int | None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", stated)
    assert fits_at_once() == (expected or len(os.sched_getaffinity(0)))


@pytest.mark.parametrize("cores", ["1", "2"])
def test_what_is_computed_beside_is_there_when_asked_for(cores: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: range(int(cores)))
    # Other tests of the same process may have set it.
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    with computed_beside(threading.current_thread) as result:
        assert (result() is threading.current_thread()) == (cores == "1")


def test_an_error_beside_is_raised_where_the_result_is_asked_for() -> None:
    def failing() -> None:
        raise ValueError("failed")

    with computed_beside(failing) as result, pytest.raises(ValueError, match="failed"):
        result()


def test_an_error_of_the_block_is_raised() -> None:
    with pytest.raises(KeyError), computed_beside(list):
        raise KeyError
