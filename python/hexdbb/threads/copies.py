"""Work divided among copies of the process: they share what it has in memory, and send back what they find.

For work of many small steps in Python, of which threads run one at a time.
"""

from __future__ import annotations

import multiprocessing
import signal
import sys
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from multiprocessing.connection import Connection
from typing import Generic, TypeVar

from hexdbb.threads import fits_at_once

T = TypeVar("T")
R = TypeVar("R")


def in_copies(function: Callable[[Sequence[T]], Sequence[R]], items: Sequence[T], fewest: int) -> list[R]:
    """Return what a function finds for every item, in their order; a copy of the process for each core has its part.

    Where the process has other threads, whose locks a copy would hold for ever, or may use one core alone, and on
    systems other than Linux, it is called here for all.

    Parameters
    ----------
    function : callable
        Returns one result for each of some items, whichever they are. Results are pickled; changes to anything else
        are lost with the copy.
    items : sequence
    fewest : int
        Items that take as long as a copy is worth, some hundredths of a second.
    """
    count = min(fits_at_once(), len(items) // fewest) if _may_be_copied() else 1
    if count < 2:
        return list(function(items))
    copies = [_Copy(function, items[part::count]) for part in range(1, count)]
    try:
        parts = [function(items[::count]), *(copy.result() for copy in copies)]
    finally:
        for copy in copies:
            copy.end()
    return [parts[place % count][place // count] for place in range(len(items))]


def _may_be_copied() -> bool:
    is_worker = multiprocessing.current_process().daemon
    return sys.platform == "linux" and threading.active_count() == 1 and not is_worker


class _Copy(Generic[T, R]):
    """A copy of the process with its part of the work."""

    def __init__(self, function: Callable[[Sequence[T]], Sequence[R]], items: Sequence[T]) -> None:
        context = multiprocessing.get_context("fork")
        self._work = (function, items)
        self._results, sender = context.Pipe(duplex=False)
        self._process = context.Process(target=_send, args=(function, items, sender), daemon=True)
        self._process.start()
        sender.close()

    def result(self) -> Sequence[R]:
        """Return what it found; of a copy that ended without (memory ran out, an error), what is found here."""
        try:
            found: Sequence[R] = self._results.recv()
        except EOFError:
            function, items = self._work
            return function(items)
        return found

    def end(self) -> None:
        """End it, whether it has finished or not."""
        self._process.terminate()
        self._process.join()
        self._results.close()


def _send(function: Callable[[Sequence[T]], Sequence[R]], items: Sequence[T], sender: Connection) -> None:
    # Ctrl-C reaches every process of the terminal: whoever made the copy ends it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    with suppress(Exception):  # it is raised where the part is computed anew
        sender.send(list(function(items)))
    sender.close()
