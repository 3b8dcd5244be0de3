"""Stdout that is gone or full: one line at most, no traceback; a record that is written stays a success."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from tests.circle_plan import circle_plan

from hexdbb.record import read_record

PLAN = circle_plan()
RUN = "-c 'from hexdbb.cli.run import main; main()' --plan plan.toml --rate 50 -o run.parquet"


@pytest.fixture
def shell(tmp_path: Path) -> Callable[[str], subprocess.CompletedProcess[str]]:
    (tmp_path / "plan.toml").write_text(PLAN)

    def run(words: str) -> subprocess.CompletedProcess[str]:
        line = ["bash", "-c", f'"$1" {words}; exit "${{PIPESTATUS[0]}}"', "bash", sys.executable]
        return subprocess.run(line, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=120)

    return run


@pytest.mark.parametrize("sink", ["> /dev/full", "| head -c0", ">&-"])
def test_result_that_cannot_be_printed_is_no_traceback(
    sink: str, shell: Callable[[str], subprocess.CompletedProcess[str]]
) -> None:
    done = shell(f"-m hexdbb.cli effects {sink}")
    assert len(done.stderr.splitlines()) <= 1
    if "full" in sink:
        assert (done.returncode, done.stderr) == (1, "error: stdout: cannot be written: No space left on device\n")


@pytest.mark.parametrize("sink", ["> /dev/full", "| head -c0", "2>&1 | head -c0"])
def test_record_is_safe_without_stdout(
    sink: str, shell: Callable[[str], subprocess.CompletedProcess[str]], tmp_path: Path
) -> None:
    done = shell(f"{RUN} {sink}")
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr
    assert read_record(tmp_path / "run.parquet").complete
    if "2>&1" not in sink:
        assert "run.parquet is whole" in done.stderr.splitlines()[-1]
