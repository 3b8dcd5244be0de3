"""Signals that ask the program to end: Ctrl-C, SIGTERM, SIGQUIT, a closed terminal or connection (SIGHUP).

Until axes may move such a signal ends the program as usual. From then on it is noted only: the next check of the loop
finds it, the axes stop, the record is written, and further signals change nothing of that.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

MEANING = {
    signal.SIGINT: "interrupted by the user",
    signal.SIGTERM: "interrupted by the user",
    signal.SIGQUIT: "interrupted by the user (SIGQUIT)",
    signal.SIGHUP: "interrupted, the terminal was closed (SIGHUP)",
}
"""Signals that are watched, each as the cause that a record keeps."""

Handler = Callable[..., object] | int | None


class Interrupts:
    """Signals that have asked the program to end.

    Attributes
    ----------
    requested : str or None
        Meaning of the first one that was noted.
    """

    def __init__(self) -> None:
        self.requested: str | None = None
        self._noted_only = self._watching = False

    @contextmanager
    def watched(self) -> Iterator[None]:
        """Receive the signals for the length of the context; in another thread than the main one there are none."""
        if self._watching or threading.current_thread() is not threading.main_thread():
            yield
            return
        before: dict[signal.Signals, Handler] = {}
        for number in MEANING:
            # nohup(1) asks to survive the terminal.
            if number is not signal.SIGHUP or signal.getsignal(number) is not signal.SIG_IGN:
                before[number] = signal.signal(number, self._receive)
        self._watching = True
        try:
            yield
        finally:
            self._watching = False
            for number, handler in before.items():
                signal.signal(number, handler)

    def note_only(self) -> None:
        """Note signals from now on instead of ending the program: axes are about to move, or a record is written."""
        self._noted_only = True

    def _receive(self, number: int, _frame: object) -> None:
        if not self._noted_only:
            raise KeyboardInterrupt
        self.requested = self.requested or MEANING[signal.Signals(number)]
