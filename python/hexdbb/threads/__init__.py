"""One thread for linear algebra: the matrices here have tens of columns.

OpenBLAS divides each product among all cores, which wait for one another: on a computer that does other work beside,
`discover` took nine times the CPU time and the wall time of one thread.
"""

from __future__ import annotations

from collections.abc import Callable
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
