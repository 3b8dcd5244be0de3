"""An effect of the user's own, tried in a process of its own before it is run in the workbench.

A file that loops for ever, or a function that does, would stop the page; here the process is ended. What ended once on
the same readings ends again: after that the file is run like one that is named by ``--effects``.
"""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from hexdbb.discovery import require_usable_effects
from hexdbb.effects import load_effects
from hexdbb.errors import HexdbbError, InputError
from hexdbb.importing import Mapping, read_measured
from hexdbb.model import new_model
from hexdbb.samples import Samples

COMPUTING_S = 20
"""Limits the processor time: reading 100,000 readings takes one second, evaluating an effect for them milliseconds. It
does not count while others compute, so that a busy computer refuses nothing."""
WAITING_S = 120.0
"""Limits the time by the clock, for what waits for ever without computing."""
START = "import sys; from hexdbb.workbench.own_code import main; main(*sys.argv[1:])"


def require_ending(
    effects: Path,
    records: Sequence[Path],
    computing_s: int = COMPUTING_S,
    waiting_s: float = WAITING_S,
    mapping: Mapping | None = None,
) -> None:
    """Check that the effects of a file can be evaluated for some records, and that they end.

    `mapping` says how records of other programs are read.

    Raises
    ------
    InputError
        The file does not run, an effect of it cannot be used (with file and line), or it did not end in time: its
        process was ended.
    """
    how = (mapping or Mapping()).model_dump_json(by_alias=True, exclude_unset=True)
    with subprocess.Popen(
        [sys.executable, "-c", START, str(computing_s), str(effects), how, *map(str, records)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as started:
        try:
            _, said = started.communicate(timeout=waiting_s)
        except subprocess.TimeoutExpired:
            raise _not_ended(effects) from None
        finally:
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(started.pid, signal.SIGKILL)  # whatever it started, too
    if started.returncode == -signal.SIGXCPU:
        raise _not_ended(effects)
    if started.returncode != 0:
        lines = said.strip().splitlines() or [f"{effects}: ended the process with status {started.returncode}"]
        raise InputError(lines[-1])


def main(computing_s: str, effects: str, how: str, *records: str) -> None:
    """Load a file of effects and evaluate each for the readings of some records; exit with 2 where that is refused.

    `how` is the JSON of a mapping, by which records of other programs are read.
    """
    resource.setrlimit(resource.RLIMIT_CPU, (int(computing_s), resource.RLIM_INFINITY))
    try:
        found = load_effects(effects)
        mapping = Mapping.model_validate_json(how)
        samples = Samples.of([read_measured(path, mapping) for path in records])
        model = new_model(samples.machine, []).knowing_effects(found)
        require_usable_effects(samples, model, [each.name for each in found])
    except HexdbbError as error:
        sys.stderr.write(f"{error}\n")
        sys.exit(error.exit_status)


def _not_ended(effects: Path) -> InputError:
    return InputError(f"{effects}: did not end and was stopped (expected a file, and functions, that end)")
