"""A function computed in a process of its own while this one goes on.

The process is forked: it begins with all that this one has read and computed, and sends back the result alone. That
serves what takes a second and returns little. Threads do not: Python runs one at a time, and matplotlib keeps it.
"""

from __future__ import annotations

import os
import pickle
import signal
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Generic, NoReturn, TypeVar

R = TypeVar("R")


@contextmanager
def beside(function: Callable[[], R]) -> Iterator[Callable[[], R]]:
    """Compute a function in a forked process while the block goes on.

    Where the process returns nothing, because the function raised an exception, its result cannot be pickled, or
    something ended the process, the function is computed once more in this one, so that an error surfaces as without
    it. That is also what happens where no process can be forked, or where there is one processor only.

    Parameters
    ----------
    function : callable
        Has no effect but its result. It may run twice.

    Yields
    ------
    callable
        Waits for the result and returns it; called once. Where it is not called, the process ends with the block.
    """
    if not _can_fork():
        yield function
        return
    process = _Forked(function)
    try:
        yield process.result
    finally:
        process.end()


def _can_fork() -> bool:
    """Check for Linux and two processors: the linear algebra of macOS does not work after a fork."""
    return sys.platform == "linux" and len(os.sched_getaffinity(0)) > 1


class _Forked(Generic[R]):
    """The other process, and the pipe from it."""

    def __init__(self, function: Callable[[], R]) -> None:
        self._function = function
        here, there = os.pipe()
        with warnings.catch_warnings():
            # Python 3.12 warns that threads of this process are not in the other, where their locks may stay closed:
            # those of progress displays and of Arrow, which the function does not use.
            warnings.simplefilter("ignore", DeprecationWarning)
            self._process: int | None = os.fork()
        if self._process == 0:
            os.close(here)
            _compute(function, there)
        os.close(there)
        self._pipe = os.fdopen(here, "rb")

    def result(self) -> R:
        sent = self._pipe.read()
        if self._status() != 0:
            return self._function()
        result: R = pickle.loads(sent)
        return result

    def end(self) -> None:
        """End the process where its result is not wanted any more."""
        self._pipe.close()
        if self._process is not None:
            with suppress(ProcessLookupError):
                os.kill(self._process, signal.SIGKILL)
            self._status()

    def _status(self) -> int:
        assert self._process is not None
        _, status = os.waitpid(self._process, 0)
        self._process = None
        return status


def _compute(function: Callable[[], object], there: int) -> NoReturn:
    """Send the function's result, and end without what a program does at its end: files and streams are the other's."""
    status = 1
    try:
        signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C reaches both processes, and is reported by the other
        with os.fdopen(there, "wb") as pipe:
            pipe.write(pickle.dumps(function(), pickle.HIGHEST_PROTOCOL))
        status = 0
    finally:
        os._exit(status)
