"""Freed memory goes back to the system."""

from __future__ import annotations

import platform
from pathlib import Path

import numpy as np
import pytest

from hexdbb.threads.heap import gives_back

BLOCK, BLOCKS = 10_000, 10_000
"""Numbers of a block, 80 kB, which the C library does not take from the system one by one, and how many are made."""


def resident_bytes() -> int:
    status = Path("/proc/self/status").read_text(encoding="ascii")
    return 1024 * next(int(line.split()[1]) for line in status.splitlines() if line.startswith("VmRSS"))


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="only glibc can give memory back")
def test_what_a_function_used_is_given_back() -> None:
    kept = []

    def use() -> int:
        every = [np.ones(BLOCK) for _ in range(BLOCKS)]
        kept.extend(every[99::100])  # between them all is freed
        return resident_bytes()

    used = gives_back(use)()
    assert used - resident_bytes() > 0.8 * 8 * BLOCK * BLOCKS
    assert sum(map(np.sum, kept)) == BLOCK * len(kept)
