"""The process of a page that watches a run: ``python -m hexdbb.live [--open]``, started by `hexdbb-run --watch`.

Messages come on stdin, a line of JSON each; the address goes to stdout.
"""

from __future__ import annotations

import json
import os
import signal
import sys
import threading
import time
import webbrowser
from contextlib import suppress

from nicegui import Client

from hexdbb.live.page import LivePage
from hexdbb.live.seen import SeenRun
from hexdbb.live.stop import Stop
from hexdbb.pages.serving import serve_page

NICENESS = 10
"""The loop has the right of way, where it was granted no real-time scheduling."""
LINGER_S = 10.0
"""Time after the run, s, after which a page ends that no browser shows: one that was slow to open still gets it."""
LONGEST_S = 3600.0
"""Time after the run, s, after which it ends in any case."""


def main() -> None:
    """Serve the page until some time after the run."""
    os.nice(NICENESS)
    run, stop = SeenRun(), Stop()
    threading.Thread(target=_hear, args=(run,), daemon=True).start()

    def ready(address: str) -> None:
        sys.stdout.write(f"{address}\n")
        sys.stdout.flush()
        _fall_silent()
        if "--open" in sys.argv[1:]:
            webbrowser.open(address)

    def build() -> None:
        LivePage(run, stop)

    with suppress(KeyboardInterrupt):
        serve_page(build, "hexdbb-run", ready=ready)


def _fall_silent() -> None:
    """Write to nowhere: nobody reads stdout and stderr after the address."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):
        os.dup2(nowhere, stream)
    os.close(nowhere)


def _hear(run: SeenRun) -> None:
    """Take messages until the run ends, then end this process when nobody looks any more."""
    for line in sys.stdin.buffer:
        with suppress(ValueError, KeyError):  # the last line of a run that was killed
            run.take(json.loads(line))
    run.lose()
    ended_s = seen_s = time.monotonic()
    while time.monotonic() - ended_s < LONGEST_S and time.monotonic() - seen_s < LINGER_S:
        time.sleep(1.0)
        if any(client.has_socket_connection for client in list(Client.instances.values())):
            seen_s = time.monotonic()
    os.kill(os.getpid(), signal.SIGINT)


if __name__ == "__main__":
    main()
