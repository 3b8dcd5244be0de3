"""A function computed in a process of its own: its result, its errors, its end."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from hexdbb import processes
from hexdbb.errors import InputError
from hexdbb.processes import beside

needs_fork = pytest.mark.skipif(not processes._can_fork(), reason="one processor, or no fork")


def test_the_result_is_that_of_the_function() -> None:
    table = np.arange(300_000.0)
    with beside(lambda: table[::-1]) as result:
        np.testing.assert_array_equal(result(), table[::-1])


@needs_fork
def test_it_is_computed_in_another_process_while_this_one_goes_on(tmp_path: Path) -> None:
    def when_told() -> int:
        while not (tmp_path / "told").exists():
            time.sleep(0.01)
        return os.getpid()

    with beside(when_told) as result:
        (tmp_path / "told").touch()  # reached only because the function does not keep this process waiting
        assert result() != os.getpid()


def test_where_nothing_can_be_forked_it_is_computed_here(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(processes, "_can_fork", lambda: False)
    with beside(os.getpid) as result:
        assert result() == os.getpid()


def test_an_error_surfaces_as_it_is() -> None:
    def fails() -> None:
        raise InputError("mine.py: line 3: wrong")

    with pytest.raises(InputError, match=r"mine\.py: line 3: wrong"), beside(fails) as result:
        result()


def test_what_cannot_be_sent_is_computed_here() -> None:
    with beside(lambda: lambda: 7) as result:
        assert result()() == 7


def test_a_process_that_is_killed_leaves_the_work_to_this_one() -> None:
    here = os.getpid()

    def killed_elsewhere() -> int:
        if os.getpid() != here:
            os.kill(os.getpid(), signal.SIGKILL)
        return os.getpid()

    with beside(killed_elsewhere) as result:
        assert result() == here


@needs_fork
def test_an_error_in_the_block_ends_the_process(tmp_path: Path) -> None:
    def long() -> None:
        (tmp_path / "pid").write_text(str(os.getpid()), encoding="ascii")
        (tmp_path / "begun").touch()
        time.sleep(60.0)

    with pytest.raises(KeyboardInterrupt), beside(long):
        while not (tmp_path / "begun").exists():
            time.sleep(0.01)
        raise KeyboardInterrupt
    with pytest.raises(ProcessLookupError):
        os.kill(int((tmp_path / "pid").read_text(encoding="ascii")), 0)


@needs_fork
def test_the_process_writes_nothing_of_this_ones_output() -> None:
    lines = (
        "from hexdbb.processes import beside\n"
        "import atexit; atexit.register(print, 'end')\n"
        "print('begin')\n"
        "with beside(lambda: 5) as result: print(result())\n"
    )
    shown = subprocess.run([sys.executable, "-c", lines], check=True, capture_output=True, text=True)
    assert (shown.stdout.split(), shown.stderr) == (["begin", "5", "end"], "")
