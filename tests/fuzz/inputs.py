"""One damaged input read: accepted, refused with one line, or a failure of the reader."""

from __future__ import annotations

import random
import shutil
import signal
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from tests.fuzz.formats import FORMATS, Format, good_files

from hexdbb.errors import HexdbbError

LONGEST_S = 10
"""Time after which a reader counts as hung, s: a thousand times what a good file takes."""
LONGEST_MESSAGE = 1000
"""Characters of a message: a few lines of a terminal."""
ACCEPTED, REFUSED, FAILED = "accepted", "refused", "failed"


@dataclass(frozen=True)
class Outcome:
    """What came of an input.

    Attributes
    ----------
    format : str
    kind : str
        `ACCEPTED`, `REFUSED` or `FAILED`.
    text : str
        The message, or what failed.
    data : bytes
        The input, if it failed.
    """

    format: str
    kind: str
    text: str = ""
    data: bytes = b""


class HungError(BaseException):
    """Raised in a reader that does not end; no reader catches it."""


@cache
def good_folder() -> Path:
    """Return a folder with a good file of every format, for the length of this process."""
    folder = Path(tempfile.mkdtemp(prefix="hexdbb-fuzz-"))
    good_files(folder)
    return folder


def tidy() -> None:
    """Remove the folder of good files."""
    shutil.rmtree(good_folder(), ignore_errors=True)
    good_folder.cache_clear()


def random_input(number: int, seed: int) -> tuple[Format, bytes]:
    """Return the format and the bytes of an input; the same number and seed give the same input."""
    rng = random.Random(f"{seed} {number}")
    chosen = rng.choices(FORMATS, [each.weight for each in FORMATS])[0]
    return chosen, chosen.input((good_folder() / chosen.file).read_bytes(), rng)


def outcome_of(chosen: Format, data: bytes) -> Outcome:
    """Read an input in place of the good file."""
    path = good_folder() / chosen.file
    good = path.read_bytes()
    path.write_bytes(data)
    try:
        with _time_limit():
            chosen.read(path)
        return Outcome(chosen.name, ACCEPTED)
    except HexdbbError as error:
        fault = _fault_of(str(error))
        return Outcome(chosen.name, FAILED, fault, data) if fault else Outcome(chosen.name, REFUSED, str(error))
    except HungError:
        return Outcome(chosen.name, FAILED, f"not read after {LONGEST_S} s", data)
    except Exception as error:  # the finding itself: what a user would see as a traceback, whatever its type
        return Outcome(chosen.name, FAILED, f"{type(error).__name__}: {str(error)[:200]!r} {_place(error)}", data)
    finally:
        path.write_bytes(good)


def _fault_of(message: str) -> str:
    """Return what is wrong with a message, or an empty text."""
    if "\n" in message or "\r" in message:
        return f"message of several lines: {message[:200]!r}"
    if not message.isprintable():
        return f"message with control characters: {message[:200]!r}"
    if len(message) > LONGEST_MESSAGE:
        return f"message of {len(message)} characters: {message[:200]!r}"
    if "Traceback" in message:
        return f"traceback in a message: {message[:200]!r}"
    return "" if message.strip() else "empty message"


def _place(error: Exception) -> str:
    """Return file and line that raised."""
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    return "" if trace is None else f"in {Path(trace.tb_frame.f_code.co_filename).name}:{trace.tb_lineno}"


@contextmanager
def _time_limit() -> Iterator[None]:
    def end(_number: int, _frame: object) -> None:
        raise HungError

    before = signal.signal(signal.SIGALRM, end)
    signal.alarm(LONGEST_S)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)
