"""Real-time scheduling and locked memory for the loop, as far as the system permits.

Source: sched(7), mlockall(2). The requests are independent of each other, and the loop runs without any of them.
"""

from __future__ import annotations

import ctypes
import gc
import os
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pyarrow as pa

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


SWITCH_S = 0.0005
"""Longest time that another thread of this process keeps the loop waiting, s: an eighth of a cycle at 250 Hz. Python's
5 ms would be more than the cycle."""
STACK_BYTES = 1 << 20
"""Stack of a thread begun in real time: locked memory is written at once, and eight megabytes take milliseconds."""


@contextmanager
def _small_steps() -> Iterator[None]:
    """Let threads take turns often, begin with small stacks, and let Arrow take memory bit by bit.

    Arrow's own pool maps an arena at its first use; under `mlockall` all of it is written at once (376 ms measured).
    """
    switch_s, stack, pool = sys.getswitchinterval(), threading.stack_size(STACK_BYTES), pa.default_memory_pool()
    sys.setswitchinterval(SWITCH_S)
    pa.set_memory_pool(pa.system_memory_pool())
    try:
        yield
    finally:
        pa.set_memory_pool(pool)
        threading.stack_size(stack)
        sys.setswitchinterval(switch_s)


def give_way() -> None:
    """Let this thread, and those it starts, give way to the loop: a thread of equal priority would keep its core.

    One step below only: at ordinary priority other programs could keep the thread waiting that holds the interpreter's
    lock, and with it the loop.
    """
    if os.sched_getscheduler(0) == os.SCHED_FIFO:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(FIFO_PRIORITY - 1))


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
        with _small_steps():
            yield refused
    finally:
        gc.enable()
        gc.unfreeze()
        if hasattr(os, "sched_setscheduler"):
            os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
        if not refused:
            ctypes.CDLL(None).munlockall()
