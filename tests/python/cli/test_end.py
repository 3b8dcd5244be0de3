"""The end of a program: nothing is taken apart, and nothing that was to be done is left out."""

from __future__ import annotations

import subprocess
import sys

import pytest

PROGRAM = "from hexdbb_start import hexdbb; hexdbb()"
AT_EXIT = "import atexit; atexit.register(print, 'done at the end')"
LEFT = "import os; leave = os._exit; os._exit = lambda status: (print('left', flush=True), leave(status))"
TRACED = "import sys; sys.setprofile(lambda *_: None)"
WAITS = "lambda: (threading.main_thread().join(), print('ended'))"
THREAD = f"import threading; threading.Thread(target={WAITS}).start()"
"""A thread that ends when Python has begun to end."""


def ended(*lines: str) -> subprocess.CompletedProcess[str]:
    """Run lines of Python and then the program, asked for its version."""
    line = "; ".join([*lines, "import sys; sys.argv[1:] = sys.argv[1:] or ['--version']", PROGRAM])
    return subprocess.run([sys.executable, "-c", line], capture_output=True, text=True, timeout=60, check=False)


def test_what_is_registered_for_the_end_is_done_before_the_program_leaves() -> None:
    done = ended(AT_EXIT, LEFT)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.splitlines()[1:] == ["done at the end", "left"]


def test_a_thread_is_waited_for() -> None:
    assert ended(THREAD, LEFT).stdout.splitlines()[1:] == ["ended"]


@pytest.mark.parametrize(("code", "status", "said"), [("0", 0, ""), ("", 0, ""), ("3", 3, ""), ("'full'", 1, "full\n")])
def test_status(code: str, status: int, said: str) -> None:
    faulty = f"import hexdbb.cli; hexdbb.cli.main = lambda: sys.exit({code})"
    done = ended(faulty)
    assert (done.returncode, done.stderr) == (status, said)


def test_a_program_that_is_traced_ends_as_python_ends() -> None:
    assert ended(TRACED, LEFT).stdout.splitlines()[1:] == []
