"""Ctrl-C is one line and exit status 130, never a traceback: while packages are imported, and in a command."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest
from tests.programs import called

from hexdbb.cli import convert

INSTALLED = Path(sysconfig.get_path("scripts"))
PROGRAMS = {
    "hexdbb": "from hexdbb_start import hexdbb; hexdbb()",
    "hexdbb-run": "from hexdbb_start import hexdbb_run as f; f()",
}
OBEYED = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)"
"""Tests that run in the background of a script inherit that the signal is ignored."""
SIGNALLED = "import os, signal\nos.kill(os.getpid(), signal.SIGINT)\n"
CAUGHT = "try:\n    import interrupting\nexcept BaseException:\n    raise ImportError('failed to import') from None\n"


@pytest.mark.parametrize(
    ("program", "module", "words"),
    [
        ("hexdbb", "click", []),
        ("hexdbb", "pyarrow", ["convert", "a.csv", "b.parquet"]),
        ("hexdbb-run", "click", []),
        ("hexdbb-run", "numpy", ["--plan", "thesis", "-o", "a.parquet"]),
    ],
)
@pytest.mark.parametrize("source", [SIGNALLED, CAUGHT], ids=["python", "compiled"])
def test_while_packages_are_imported(program: str, module: str, words: list[str], source: str, tmp_path: Path) -> None:
    """A module found before the real one gets the signal; the second source makes it another error."""
    (tmp_path / f"{module}.py").write_text(source, encoding="utf-8")
    (tmp_path / "interrupting.py").write_text(SIGNALLED, encoding="utf-8")
    line = f"{OBEYED}; import sys; sys.path.insert(0, {str(tmp_path)!r}); {PROGRAMS[program]}"
    done = subprocess.run(
        [sys.executable, "-c", line, *words], cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "error: interrupted\n")


@pytest.mark.parametrize("program", PROGRAMS)
def test_while_python_itself_starts(program: str, tmp_path: Path) -> None:
    """`sitecustomize` is imported before any line of a program."""
    (tmp_path / "sitecustomize.py").write_text(f"{OBEYED}\n{SIGNALLED}", encoding="utf-8")
    link = tmp_path / "link"
    link.symlink_to(INSTALLED / program)
    done = subprocess.run(
        [link, "--version"],
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "error: interrupted\n")


def test_a_program_without_its_installation(tmp_path: Path) -> None:
    moved = shutil.copy(INSTALLED / "hexdbb", tmp_path)
    done = subprocess.run([moved, "--version"], capture_output=True, text=True, timeout=60, check=False)
    missing = tmp_path.resolve() / "hexdbb-start"
    line = f"error: hexdbb cannot start {missing}: No such file or directory (install hexdbb again)\n"
    assert (done.returncode, done.stdout, done.stderr) == (127, "", line)


@pytest.mark.parametrize("words", [[], ["diagnose"]])
def test_the_script_of_the_programs_alone(words: list[str]) -> None:
    done = subprocess.run([INSTALLED / "hexdbb-start", *words], capture_output=True, text=True, timeout=60, check=False)
    line = "error: hexdbb-start is called by hexdbb and hexdbb-run: use these\n"
    assert (done.returncode, done.stdout, done.stderr) == (1, "", line)


def test_in_a_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(convert, "read_measured", interrupted)
    done = called("hexdbb", "convert", "a.csv", "b.parquet", folder=tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "error: interrupted\n")


def test_ignored_where_a_shell_said_so(tmp_path: Path) -> None:
    """A job in the background of a script is not ended by the Ctrl-C meant for the script."""
    line = f"import signal; signal.signal(signal.SIGINT, signal.SIG_IGN); {PROGRAMS['hexdbb-run']}"
    (tmp_path / "numpy.py").write_text(SIGNALLED + "raise ImportError('went on')", encoding="utf-8")
    line = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); {line}"
    done = subprocess.run([sys.executable, "-c", line], capture_output=True, text=True, timeout=60, check=False)
    assert "went on" in done.stderr.splitlines()[-1]


@pytest.mark.parametrize("program", PROGRAMS)
def test_version(program: str) -> None:
    done = called(program, "--version")
    assert done.returncode == 0
    assert done.stdout.startswith(f"{program}, version ")
