"""The way back from page to run: SIGINT, as Ctrl-C sends it, so that there is one way to stop (`interrupts`)."""

from __future__ import annotations

import os
import signal

from hexdbb.errors import RunError


class Stop:
    """Stops the run that started this process; created while that runs."""

    def __init__(self) -> None:
        self._run = os.getppid()

    def __call__(self) -> None:
        """Ask the run to stop all six axes; raises `RunError` where it has ended: another may have its number."""
        if os.getppid() != self._run:
            raise RunError("the run's process has ended: there is nothing to stop")
        os.kill(self._run, signal.SIGINT)
