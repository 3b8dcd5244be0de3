"""One thread for linear algebra: the matrices here have tens of columns.

OpenBLAS divides each product among all cores, which wait for one another: on a computer that does other work beside,
`discover` took nine times the CPU time and the wall time of one thread.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

from threadpoolctl import threadpool_limits

P = ParamSpec("P")
R = TypeVar("R")


def one_thread(function: Callable[P, R]) -> Callable[P, R]:
    """Return the function, run with one thread for linear algebra; the caller's setting is restored after it."""

    @wraps(function)
    def limited(*args: P.args, **kwargs: P.kwargs) -> R:
        with threadpool_limits(limits=1, user_api="blas"):
            return function(*args, **kwargs)

    return limited
