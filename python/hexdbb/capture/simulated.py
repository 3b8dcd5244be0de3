"""The simulated rig as a process of its own, started for one run and ended after it."""

from __future__ import annotations

import subprocess
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from hexdbb.errors import HexdbbError, InputError, RunError

ANNOUNCEMENT = "hexdbb rig: listening on "
"""What the rig prints when it can be reached, followed by its address."""
START_TIMEOUT_S = 60.0
END_TIMEOUT_S = 5.0


@contextmanager
def simulated_rig(arguments: Sequence[str]) -> Iterator[str]:
    """Start the rig; yields the bus to reach it by, and ends it, and only it, on leaving.

    Parameters
    ----------
    arguments : options of `hexdbb rig`

    Raises
    ------
    InputError, RunError
        The rig did not start: carries what it said.
    """
    command = [sys.executable, "-m", "hexdbb.cli", "rig", "--exit-with-parent", *arguments]
    # A session of its own: Ctrl-C in the terminal is for the controller, which must find the rig there to stop it.
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    try:
        yield f"socketcand:{_address(process)}"
    finally:
        process.terminate()
        try:
            process.wait(END_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        for stream in (process.stdout, process.stderr):
            if stream is not None:
                stream.close()


def _address(process: subprocess.Popen[str]) -> str:
    """Wait for the announcement; what the rig says later is drained, so that it never waits for a reader."""
    assert process.stdout is not None
    assert process.stderr is not None
    said: list[str] = []
    err = threading.Thread(target=lambda stream: said.extend(stream), args=(process.stderr,), daemon=True)
    err.start()
    timer = threading.Timer(START_TIMEOUT_S, process.kill)
    timer.start()
    try:
        for line in process.stdout:
            if line.startswith(ANNOUNCEMENT):
                threading.Thread(target=process.stdout.read, daemon=True).start()
                return line.removeprefix(ANNOUNCEMENT).strip()
    finally:
        timer.cancel()
    status = process.wait()
    err.join(END_TIMEOUT_S)
    words = (said[-1].strip() if said else f"exit status {status}").removeprefix("error: ")
    failure: type[HexdbbError] = InputError if status == InputError.exit_status else RunError
    raise failure(f"the simulated rig did not start: {words}")
