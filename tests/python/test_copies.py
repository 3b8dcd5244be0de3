"""Work divided among copies of the process: what comes back, and where no copy is made."""

from __future__ import annotations

import os
import subprocess
import sys
import threading

import pytest

from hexdbb.threads import copies
from hexdbb.threads.copies import in_copies

IN_A_PROCESS_OF_ITS_OWN = """
import os, signal, sys
os.sched_getaffinity = lambda _: range(3)
from hexdbb.threads.copies import in_copies
home = os.getpid()

def work(items):
    if CASE == "ends" and os.getpid() != home:
        os.kill(os.getpid(), signal.SIGKILL)
    if CASE == "fails":
        raise ValueError("failed")
    return [(each, os.getpid()) for each in items]

CASE = sys.argv[1]
found = in_copies(work, range(10), 2)
assert [each for each, _ in found] == list(range(10)), found
print(len({pid for _, pid in found}), found[0][1] == home)
"""


def ran(case: str) -> subprocess.CompletedProcess[str]:
    """Run a case in a process that has one thread, as a command has, and may use three cores, whoever tests."""
    command = [sys.executable, "-c", IN_A_PROCESS_OF_ITS_OWN, case]
    environment = {name: value for name, value in os.environ.items() if name != "OMP_NUM_THREADS"}
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False, env=environment)


@pytest.mark.skipif(sys.platform != "linux", reason="copies are made on Linux alone")
def test_parts_are_found_in_copies_and_come_back_in_order() -> None:
    assert ran("works").stdout.split() == ["3", "True"]


def test_the_part_of_a_copy_that_ended_is_found_here() -> None:
    assert ran("ends").stdout.split() == ["1", "True"]


def test_an_error_is_raised_here_alone() -> None:
    assert ran("fails").stderr.count("ValueError: failed") == 1


@pytest.mark.parametrize("fewest", [1, 6])
def test_no_copy_is_made_beside_other_threads_nor_of_few_items(fewest: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(copies, "fits_at_once", lambda: 2)
    called: list[list[int]] = []
    waits = threading.Event()
    other = threading.Thread(target=waits.wait)
    if fewest == 1:
        other.start()
    try:
        found = in_copies(lambda items: called.append(list(items)) or [2 * each for each in items], range(10), fewest)
    finally:
        waits.set()
    assert found == [2 * each for each in range(10)]
    assert called == [list(range(10))]
