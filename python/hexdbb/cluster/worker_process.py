"""What a process does once before it works for a cluster: one thread, and freed memory kept for the next task."""

from __future__ import annotations

import ctypes
from functools import cache

from hexdbb import _core

M_TRIM_THRESHOLD, M_MMAP_THRESHOLD = -1, -3
"""Parameters of mallopt(3), as glibc's malloc.h numbers them."""
KEPT_BYTES = 64 * 2**20
"""Freed memory that a process keeps, each of its threads for itself: three times what a record of 20,000 readings
takes. By default it all goes back to the system after each record, and the next one's pages, 5,000, must be cleared
again: a tenth of the time of a record. Dask sets even less for its workers."""
LARGEST_BYTES = 16 * 2**20
"""Largest array that is taken from that memory: the columns of a record of 300,000 readings. glibc allows 32 MiB."""


@cache
def prepare_process() -> None:
    """Let the engine use one thread, because a worker has one core, and keep freed memory; once in a process.

    Where the C library is not glibc, memory is handled as it always is.
    """
    _core.limit_threads(1)
    set_option = getattr(ctypes.CDLL(None), "mallopt", None)
    if set_option is not None:
        set_option(M_TRIM_THRESHOLD, KEPT_BYTES)
        set_option(M_MMAP_THRESHOLD, LARGEST_BYTES)
