"""Real-time scheduling and locked memory for the loop, as far as the system permits.

Source: sched(7), mlockall(2). The requests are independent of each other, and the loop runs without any of them.
"""

from __future__ import annotations

import ctypes
import gc
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager

FIFO_PRIORITY = 50
"""Priority of SCHED_FIFO (1 to 99): above ordinary processes, not above the interrupt threads of a PREEMPT_RT kernel
(50 by default), which the CAN driver needs."""
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
    """Request real-time scheduling and locked memory and switch garbage collection off, for the length of the context.

    Yields
    ------
    list of str
        One line for each request that the system did not grant.
    """
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
