"""What workers do in tests of the cluster, and processes of Dask; importable by name, as workers import it."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
from distributed import Client

from hexdbb.cluster import Results, Task, content_key, seed_of

COLUMNS = pa.schema([("group", pa.string()), ("number", pa.int64()), ("drawn", pa.float64())])
KIND = "hexdbb.test/1"


def results(url: object, partition: tuple[str, ...] = ("group",)) -> Results:
    return Results(str(url), KIND, COLUMNS, partition)


def tasks(count: int, **more: object) -> list[Task]:
    """Tasks of three groups; `more` goes into every payload, the key is of the number alone."""
    found = []
    for number in range(count):
        key = content_key("number", number)
        payload = {"number": number, "group": f"g{number % 3}", "seed": seed_of(key), **more}
        found.append(Task(key, payload, {"group": payload["group"], "number": number}))
    return found


def draw(payload: dict[str, Any]) -> list[dict[str, Any]]:
    """Two rows: the number, and what its seed draws; a note of the attempt in the folder `seen`, where one is given."""
    if folder := payload.get("seen"):
        handle, _ = _fresh(Path(folder), payload["number"])
        os.close(handle)
    time.sleep(payload.get("wait_s", 0.0))
    draws = np.random.default_rng(payload["seed"]).normal(size=2)
    return [{"group": payload["group"], "number": payload["number"], "drawn": float(each)} for each in draws]


def draw_or_fail(payload: dict[str, Any]) -> list[dict[str, Any]]:
    """As `draw`; every seventh number raises, every eleventh raises twice before it does not."""
    number = payload["number"]
    if number % 7 == 3:
        raise OSError(f"no answer for {number}")
    if number % 11 == 5 and attempts(Path(payload["seen"]), number) < 2:
        draw(payload)
        raise OSError("later")
    return draw(payload)


def draw_or_die(payload: dict[str, Any]) -> list[dict[str, Any]]:
    """As `draw`; one number kills its worker each time."""
    found = draw(payload)
    if payload["number"] == payload["deadly"]:
        os.kill(os.getpid(), signal.SIGKILL)
    return found


def nothing(payload: dict[str, Any]) -> list[dict[str, Any]]:
    """No row of even numbers, rows of two groups of odd ones: both are refused."""
    return [{"group": group, "number": payload["number"]} for group in ("a", "b")] if payload["number"] % 2 else []


def attempts(folder: Path, number: int) -> int:
    return len(list(folder.glob(f"{number}-*")))


def _fresh(folder: Path, number: int) -> tuple[int, str]:
    import tempfile

    return tempfile.mkstemp(prefix=f"{number}-", dir=folder)


def free_port() -> int:
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return int(found.getsockname()[1])


@contextlib.contextmanager
def process(*words: object, **environment: str) -> Iterator[subprocess.Popen[bytes]]:
    """Run a Python module as a process of its own until the block ends."""
    command = [sys.executable, "-m", *map(str, words)]
    running = subprocess.Popen(
        command, env={**os.environ, **environment}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    try:
        yield running
    finally:
        running.kill()
        running.wait()


def scheduler(port: int, *words: object) -> contextlib.AbstractContextManager[subprocess.Popen[bytes]]:
    """Run `dask scheduler`."""
    where = words or ("--host", "tcp://127.0.0.1", "--port", port)
    return process("dask", "scheduler", *where, "--no-dashboard", "--no-show")


def worker(address: str, *words: object, **environment: str) -> contextlib.AbstractContextManager[Any]:
    """Run `dask worker` with one thread and no nanny, so that it is one process."""
    words = ("--nthreads", 1, "--no-nanny", "--no-dashboard", "--host", "127.0.0.1", *words)
    return process("dask", "worker", address, *words, **environment)


def wait_for_workers(address: str, count: int) -> None:
    """Wait until a scheduler has so many workers."""
    with Client(address, timeout=30) as client:
        client.wait_for_workers(count, timeout=60)
