"""A page that watches a run, in a process of its own: started before anything moves, and never waited for.

Samples come from the thread of the journal, when they are on disk, into a queue of bounded length; a thread of this
module puts them and the state of the run into a pipe that it never waits for. What does not fit is dropped: the state
is out of date then anyway, and the oldest samples are left out of the picture, not of the record. The loop knows
nothing of it. The page has one way back: it sends this process SIGINT, as Ctrl-C does (`interrupts`).
"""

from __future__ import annotations

import json
import os
import select
import subprocess
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from hexdbb.capture.observation import Message, States, begin, end, rows
from hexdbb.capture.request import Request, RunProgress
from hexdbb.errors import RunError
from hexdbb.record.columns import Columns

PERIOD_S = 0.2
"""Time between two states told, s: the eye takes it for continuous, and each costs the loop's interpreter
less than a tenth of a millisecond."""
WAITING_BATCHES = 64
"""Limits the queue: half a minute of samples, for a page that was stopped for a while."""
START_TIMEOUT_S = 60.0
"""Longest time until the page can be opened, s: a second or two on an idle computer, more on one that compiles."""
END_TIMEOUT_S = 1.0
"""Longest time given to a page to take the last message, s: the record is safe, and the user waits for the prompt."""


class PagePipe:
    """Lines of JSON into the pipe of a page, without waiting.

    Parameters
    ----------
    descriptor : int
        Of the pipe; does not block from now on.
    """

    def __init__(self, descriptor: int) -> None:
        os.set_blocking(descriptor, False)
        self._descriptor, self._rest = descriptor, b""

    @property
    def is_free(self) -> bool:
        """Whether the line before was taken whole, so that another may follow."""
        return not self._rest

    def send(self, message: Message | None = None) -> bool:
        """Write a message, or what the pipe did not take of the one before; return whether all was taken.

        Raises
        ------
        BrokenPipeError
            The page has ended.
        """
        if message is not None:
            self._rest += json.dumps(message).encode() + b"\n"
        with suppress(BlockingIOError):
            while self._rest:
                self._rest = self._rest[os.write(self._descriptor, self._rest) :]
        return self.is_free


class PageFeed:
    """Sends a page what happens, from a thread of its own.

    Parameters
    ----------
    pipe : PagePipe
    progress : RunProgress
        Receives a note if the page ends before the run.
    """

    def __init__(self, pipe: PagePipe, progress: RunProgress) -> None:
        self._pipe, self._progress = pipe, progress
        self._written: deque[Columns] = deque(maxlen=WAITING_BATCHES)
        self._finished = threading.Event()
        self._thread = threading.Thread(target=self._feed, name="hexdbb-page", daemon=True)
        progress.written = self._written.append
        self._thread.start()

    def finish(self, outcome: str | None) -> None:
        """Send how the run ended, if the page reads."""
        self._finished.set()
        self._thread.join()
        until_s = time.monotonic() + END_TIMEOUT_S
        with suppress(BrokenPipeError):
            for message in (*self._waiting(), States(self._progress).now(), end(outcome)):
                taken = self._pipe.send(message)
                while not taken and time.monotonic() < until_s:
                    time.sleep(PERIOD_S / 10)
                    taken = self._pipe.send()

    def _feed(self) -> None:
        states = States(self._progress)
        try:
            while not self._finished.wait(PERIOD_S):
                if self._pipe.send():
                    self._pipe.send(states.now())
                for message in self._waiting():
                    self._pipe.send(message)
        except BrokenPipeError:
            self._progress.notes.append("the page that watches has ended; the run goes on")

    def _waiting(self) -> Iterator[Message]:
        """Yield what waits in the queue, as long as the pipe takes it."""
        while self._written and self._pipe.is_free:
            yield from rows(self._written.popleft())


@contextmanager
def watched_by_page(
    request: Request, progress: RunProgress, open_browser: bool, ready: Callable[[str], None]
) -> Iterator[None]:
    """Start a page, wait until it can be opened, and feed it for the length of the context; it outlives it for a while.

    Parameters
    ----------
    request, progress : Request, RunProgress
        Of the run.
    open_browser : bool
        Whether the page opens the browser itself.
    ready : callable
        Called with the address.

    Raises
    ------
    RunError
        The page did not start; nothing has moved yet.
    """
    words = [sys.executable, "-m", "hexdbb.live", *(["--open"] if open_browser else [])]
    # A session of its own: Ctrl-C in the terminal is for the run.
    process = subprocess.Popen(
        words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True
    )
    assert process.stdin is not None
    assert process.stdout is not None
    assert process.stderr is not None
    try:
        pipe = PagePipe(process.stdin.fileno())
        with suppress(BrokenPipeError):  # a page that has ended already: what it said of it is read below
            pipe.send(begin(request))
        ready(_address(process))
    except BaseException:
        process.kill()
        process.wait()
        _close(process)
        raise
    feed, outcome = PageFeed(pipe, progress), "an error in this program"
    try:
        yield
        outcome = ""
    except BaseException as error:
        outcome = str(error) or "interrupted before anything moved"
        raise
    finally:
        feed.finish(outcome or None)
        _close(process)
        process.poll()


def _address(process: subprocess.Popen[bytes]) -> str:
    """Return the address that the page prints; raises `RunError` where it prints none."""
    assert process.stdout is not None
    assert process.stderr is not None
    ready, _, _ = select.select([process.stdout], [], [], START_TIMEOUT_S)
    address = process.stdout.readline().decode().strip() if ready else ""
    if address:
        return address
    if not ready:
        process.kill()
    said = process.stderr.read().decode(errors="replace").strip().splitlines()
    silent = f"it ended with status {process.wait()}" if ready else f"nothing heard of it within {START_TIMEOUT_S:g} s"
    why = said[-1] if said else silent
    raise RunError(f"--watch: the page did not start: {why}; nothing has moved")


def _close(process: subprocess.Popen[bytes]) -> None:
    for stream in (process.stdin, process.stdout, process.stderr):
        if stream is not None:
            with suppress(OSError):
                stream.close()
