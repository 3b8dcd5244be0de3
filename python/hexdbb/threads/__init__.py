"""One thread for linear algebra, whose matrices have tens of columns; as many fits at once as there are cores.

OpenBLAS divides each product among all cores, which wait for one another: on a computer that does other work beside,
`discover` took nine times the CPU time and the wall time of one thread.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import cache, wraps
from typing import ParamSpec, TypeVar

from threadpoolctl import ThreadpoolController

P = ParamSpec("P")
R = TypeVar("R")


def one_thread(function: Callable[P, R]) -> Callable[P, R]:
    """Return the function, run with one thread for linear algebra; the caller's setting is restored after it."""

    @wraps(function)
    def limited(*args: P.args, **kwargs: P.kwargs) -> R:
        with _libraries().limit(limits=1, user_api="blas"):
            return function(*args, **kwargs)

    return limited


@cache
def _libraries() -> ThreadpoolController:
    """Return the libraries that are loaded: NumPy's is from the start, and a search for them takes milliseconds."""
    return ThreadpoolController()


def fits_at_once() -> int:
    """Return how many fits may run beside each other: the cores of this process, or fewer by ``OMP_NUM_THREADS``.

    Dask sets it to one in its workers, of which there is one a core.
    """
    cores, wanted = len(os.sched_getaffinity(0)), os.environ.get("OMP_NUM_THREADS", "")
    return min(cores, int(wanted)) if wanted.isdecimal() and int(wanted) > 0 else cores


@contextmanager
def computed_beside(function: Callable[[], R]) -> Iterator[Callable[[], R]]:
    """Let a function run in a thread of its own while the block does; on one core, when its result is asked for.

    Yields
    ------
    callable
        Waits for the function and returns its result, or raises its error. At the block's end it is waited for anyway.
    """
    if fits_at_once() < 2:
        yield function
        return
    with ThreadPoolExecutor(1) as pool:
        yield pool.submit(function).result
