"""The simulated rig served by a thread of the test's process: options and bus of `hexdbb rig`, no interpreter started.

Tests of the rig's process itself (its end, its signals, its death) start it as one.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hexdbb.cli.rig import command, simulated
from hexdbb.rig.socketcand import SocketcandServer


@contextmanager
def rig_in_thread(*options: object, log: Path | None = None) -> Iterator[int]:
    """Serve a rig and yield its port.

    Parameters
    ----------
    *options : object
        Options of `hexdbb rig` that say what is simulated, such as ``"--fault", "gauge-frozen"``.
    log : Path, optional
        Receives what `hexdbb rig --verbose` logs.
    """
    chosen = command.make_context("rig", list(map(str, options))).params
    names = ("machine_path", "truth_path", "seed", "faults", "stall_tolerance_s")
    rig, _ = simulated(**{name: chosen[name] for name in names})
    server = SocketcandServer(0, rig.receive_all, rig.poll, rig.controller_gone)
    rig.transmit, rig.on_bus_lost = server.transmit, server.disconnect_all
    thread = threading.Thread(target=server.serve, name="rig", daemon=True)
    with logged(log):
        thread.start()
        try:
            yield server.port
        finally:
            server.stop()
            thread.join()


@contextmanager
def logged(path: Path | None) -> Iterator[None]:
    """Append what the rig logs to a file."""
    if path is None:
        yield
        return
    logger, handler = logging.getLogger("hexdbb.rig"), logging.FileHandler(path, encoding="utf-8")
    before = logger.level
    logger.addHandler(handler)
    logger.setLevel(logging.DEBUG)
    try:
        yield
    finally:
        logger.setLevel(before)
        logger.removeHandler(handler)
        handler.close()
