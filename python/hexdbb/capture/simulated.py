"""The simulated rig as a separate process, started for one run and ended after it."""

from __future__ import annotations

import subprocess
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from hexdbb.errors import HexdbbError, InputError, RunError

ANNOUNCEMENT = "hexdbb rig: listening on "
"""Text the rig prints before its address when it accepts connections."""
START_TIMEOUT_S = 60.0
"""Longest time until the rig accepts connections, s: some seconds on an idle computer, more on one that compiles."""
END_TIMEOUT_S = 5.0
"""Longest time from SIGTERM to the end of the rig, s; then it is killed, because nothing of it has to be kept."""


@contextmanager
def simulated_rig(arguments: Sequence[str]) -> Iterator[str]:
    """Start a simulated rig and end it on leaving the context.

    Parameters
    ----------
    arguments : sequence of str
        Options of `hexdbb rig`, for example ``["--seed", "3"]``.

    Yields
    ------
    str
        Its bus for `open_bus`: ``socketcand:127.0.0.1:port``.

    Raises
    ------
    InputError, RunError
        The rig did not start; carries its error message.
    """
    command = [sys.executable, "-m", "hexdbb.cli", "rig", "--exit-with-parent", *arguments]
    # A session of its own: Ctrl-C in the terminal is for the controller, which needs the rig to stop the axes.
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
    """Return the address from the announcement; later output is read and dropped, so that the rig never blocks."""
    assert process.stdout is not None
    assert process.stderr is not None
    messages: list[str] = []
    err = threading.Thread(target=lambda stream: messages.extend(stream), args=(process.stderr,), daemon=True)
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
    message = (messages[-1].strip() if messages else f"exit status {status}").removeprefix("error: ")
    failure: type[HexdbbError] = InputError if status == InputError.exit_status else RunError
    raise failure(f"the simulated rig did not start: {message}")
