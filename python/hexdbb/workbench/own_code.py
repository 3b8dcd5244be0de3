"""An effect of the user's own, tried in a process of its own before it is run in the workbench.

A file that loops for ever, or a function that does, would stop the page; here the process is ended. What ended once on
the same readings ends again: after that the file is run like one that is named by ``--effects``.

``python -m hexdbb.workbench.own_code EFFECTS.py RECORD...`` loads the file and evaluates every effect in it for the
records; what it refuses is one line on stderr, exit status 2.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from hexdbb.discovery import require_usable_effects
from hexdbb.effects import load_effects
from hexdbb.errors import HexdbbError, InputError
from hexdbb.model import new_model
from hexdbb.record import read_record
from hexdbb.samples import Samples

TIMEOUT_S = 20.0
"""Limits the run: reading 100,000 readings takes one second, evaluating an effect for them milliseconds."""


def require_ending(effects: Path, records: Sequence[Path], timeout_s: float = TIMEOUT_S) -> None:
    """Check that the effects of a file can be evaluated for some records, and that they end.

    Raises
    ------
    InputError
        The file does not run, an effect of it cannot be used (with file and line), or it did not end in time: its
        process was ended.
    """
    words = [sys.executable, "-m", "hexdbb.workbench.own_code", str(effects), *map(str, records)]
    with subprocess.Popen(
        words,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as started:
        try:
            _, said = started.communicate(timeout=timeout_s)
        except subprocess.TimeoutExpired:
            stopped = f"{effects}: did not end within {timeout_s:g} s and was stopped"
            raise InputError(f"{stopped} (expected a file, and functions, that end)") from None
        finally:
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(started.pid, signal.SIGKILL)  # whatever it started, too
    if started.returncode != 0:
        lines = said.strip().splitlines() or [f"{effects}: ended with status {started.returncode}"]
        raise InputError(lines[-1].removeprefix("error: "))


def main(effects: str, *records: str) -> None:
    """Load a file of effects and evaluate each for the readings of some records."""
    found = load_effects(effects)
    samples = Samples.of([read_record(path) for path in records])
    model = new_model(samples.machine, []).knowing_effects(found)
    require_usable_effects(samples, model, [each.name for each in found])


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except HexdbbError as error:
        sys.stderr.write(f"error: {error}\n")
        sys.exit(error.exit_status)
