"""The programs `hexdbb` and `hexdbb-run` called in this process: what a user would see, without a new interpreter.

To start an interpreter and import the packages takes longer than most commands do. Where the process is the subject of
a test (signals, kills, streams that are closed or full) it is started; `tests/python/documents` runs every command that
the pages show as a process.
"""

from __future__ import annotations

import io
import subprocess
import sys
from contextlib import chdir, redirect_stderr, redirect_stdout
from pathlib import Path

from hexdbb.cli import main as hexdbb_main
from hexdbb.cli.run import main as hexdbb_run_main

PROGRAMS = {"hexdbb": hexdbb_main, "hexdbb-run": hexdbb_run_main}


def called(program: str, *words: object, folder: Path | str = ".") -> subprocess.CompletedProcess[str]:
    """Call a program in a folder; return exit status and output as `subprocess.run` does.

    Anything but `SystemExit` is raised: it would be a traceback.
    """
    line = [program, *map(str, words)]
    out, err, before = io.StringIO(), io.StringIO(), sys.argv
    with chdir(folder), redirect_stdout(out), redirect_stderr(err):
        sys.argv = line
        try:
            PROGRAMS[program]()
            status = 0
        except SystemExit as end:
            status = end.code if isinstance(end.code, int) else int(end.code is not None)
        finally:
            sys.argv = before
    return subprocess.CompletedProcess(line, status, out.getvalue(), err.getvalue())
