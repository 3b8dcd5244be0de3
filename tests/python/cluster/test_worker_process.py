"""A prepared process keeps freed memory: the pages of one task serve the next."""

import ctypes
import subprocess
import sys

import pytest

PROGRAM = """
import resource, sys
import numpy as np
from hexdbb.cluster.worker_process import prepare_process
if sys.argv[1] == "prepared":
    prepare_process()

def task():
    return sum(float(each.sum()) for each in [np.ones(250_000) for _ in range(8)])  # 16 MB in arrays of 2 MB

task()
before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
for _ in range(5):
    task()
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""


def faults(how: str) -> int:
    done = subprocess.run([sys.executable, "-c", PROGRAM, how], capture_output=True, text=True, check=True)
    return int(done.stdout)


@pytest.mark.skipif(not hasattr(ctypes.CDLL(None), "mallopt"), reason="not glibc")
def test_pages_are_cleared_once() -> None:
    assert faults("prepared") < 0.1 * faults("as it is")
