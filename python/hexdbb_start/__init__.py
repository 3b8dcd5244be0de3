"""The programs' first lines: Ctrl-C while Python starts and packages are imported ends them without a traceback.

The commands are compiled (`cpp/start`): they start Python with the signal held back, and it is let through here. It
lies beside the package because to import anything within `hexdbb` imports what that needs first.
"""

from __future__ import annotations

import atexit
import gc
import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib import import_module

SETTINGS = {
    # Matrices have tens of columns, and fits run beside each other: threads of OpenBLAS would only wait, by spinning.
    "OPENBLAS_NUM_THREADS": "1",
    # Files are read alike on every computer; to look for plugins, the metadata of all installed packages are read.
    "PYDANTIC_DISABLE_PLUGINS": "__all__",
}
"""Environment of the programs, where the user has not set it: libraries read it while they are imported."""
INTERRUPTED = 130
"""Exit status of a program ended by Ctrl-C, as shells give it: 128 and the number of SIGINT."""


def main() -> None:
    """Run the command that is named by the first word, as the programs of `cpp/start` name themselves."""
    programs = {"hexdbb": hexdbb, "hexdbb-run": hexdbb_run}
    if len(sys.argv) < 2 or sys.argv[1] not in programs:
        sys.exit(f"error: hexdbb-start is called by {' and '.join(programs)}: use these")
    sys.argv = sys.argv[1:]
    programs[sys.argv[0]]()


def hexdbb() -> None:
    """Run the command `hexdbb`."""
    _run("hexdbb.cli")


def hexdbb_run() -> None:
    """Run the command `hexdbb-run`."""
    _run("hexdbb.cli.run")


@contextmanager
def ends_at_once() -> Iterator[None]:
    """Let Ctrl-C end the process without an exception while modules are imported: there is nothing to be saved.

    Compiled modules turn an exception during their import into one of their own, or print it. Signals that are ignored,
    handled otherwise or not this thread's are left alone.
    """
    ours = _end_at_once()
    try:
        yield
    finally:
        if ours:
            signal.signal(signal.SIGINT, signal.default_int_handler)


@contextmanager
def keeps_all() -> Iterator[None]:
    """Look for no garbage while modules are imported, nor later in what they define, which lives as long as they do.

    A search through all of it takes some 30 ms, and importing alone starts several.
    """
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        gc.enable()


def _run(module: str) -> None:
    for name, value in SETTINGS.items():
        os.environ.setdefault(name, value)
    try:
        with ends_at_once(), keeps_all():
            signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
            command = import_module(module).main
        command()
    except KeyboardInterrupt:  # between the import and the command, or after it
        _end()
    except SystemExit as ended:
        if ended.code == INTERRUPTED:  # fits may still run in threads, under which Python must not end
            _leave(INTERRUPTED)
        if _is_alone():
            _end_at_once()
            atexit._run_exitfuncs()
            _leave(_status(ended.code))
        raise
    finally:
        _end_at_once()  # what was printed is flushed; an exception while the interpreter ends would be a traceback


def _end_at_once() -> bool:
    try:
        ours = signal.getsignal(signal.SIGINT) is signal.default_int_handler
        if ours:
            signal.signal(signal.SIGINT, _end)
    except ValueError:  # not the main thread
        ours = False
    return ours


def _is_alone() -> bool:
    """Check that Python would wait for no thread, and that nobody who traces the program waits for its end."""
    others = (each for each in threading.enumerate() if each is not threading.current_thread())
    return all(each.daemon for each in others) and not (sys.gettrace() or sys.getprofile())


def _status(code: str | int | None) -> int:
    """Return the status of an exit as Python ends with it: a message is printed."""
    if isinstance(code, str):
        print(code, file=sys.stderr)
    return 0 if code is None else code if isinstance(code, int) else 1


def _leave(status: int) -> None:
    """End the process, which has said all: Python would take apart what was imported and computed, a tenth of a second.

    What waits to be written is; what was to be done at the end is the caller's.
    """
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError, AttributeError):  # closed by the shell
            stream.flush()
    os._exit(status)


def _end(*_: object) -> None:
    with suppress(OSError):  # closed by the shell
        os.write(2, b"error: interrupted\n")
    os._exit(INTERRUPTED)
