"""Ask the system for what a real-time loop needs, and say what it did not grant.

Source: sched(7), mlockall(2). Each request stands alone; none is needed for the loop to run.
"""

from __future__ import annotations

import ctypes
import gc
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager

FIFO_PRIORITY = 50
MCL_CURRENT, MCL_FUTURE = 1, 2


def _fifo() -> None:
    os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(FIFO_PRIORITY))


def _lock_memory() -> None:
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.mlockall(MCL_CURRENT | MCL_FUTURE) != 0:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))


REQUESTS: dict[str, Callable[[], None]] = {
    "real-time scheduling (SCHED_FIFO)": _fifo,
    "memory locked (mlockall)": _lock_memory,
}


@contextmanager
def real_time_process() -> Iterator[list[str]]:
    """Make this process as real-time as the system permits; yields what was not granted, one line each."""
    refused = []
    for what, request in REQUESTS.items():
        try:
            request()
        except (OSError, AttributeError) as error:
            refused.append(f"{what} not granted: {getattr(error, 'strerror', None) or error}")
    gc.collect()
    gc.freeze()
    gc.disable()
    try:
        yield refused
    finally:
        gc.enable()
        gc.unfreeze()
        if hasattr(os, "sched_setscheduler"):
            os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
        if not refused:
            ctypes.CDLL(None).munlockall()
