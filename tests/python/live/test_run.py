"""A page that dies, hangs or never starts changes nothing of the run that it watches."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from tests.browser.chromium import arguments, executable
from tests.programs import called
from tests.python.live.watched import TIMEOUT_S, long_plan, watched

from hexdbb.capture import page_feed
from hexdbb.capture.observation import Message, begin
from hexdbb.capture.request import Request
from hexdbb.cli import run_watched
from hexdbb.record import Record, read_record

OPTIONS = ("--rate", 50, "--seed", 5)


@pytest.fixture(scope="module")
def unwatched(tmp_path_factory: pytest.TempPathFactory) -> Record:
    """Return the record of the run without a page."""
    folder = tmp_path_factory.mktemp("unwatched")
    (folder / "plan.toml").write_text(long_plan(2))
    done = called("hexdbb-run", "--plan", "plan.toml", "-o", "run.parquet", *OPTIONS, folder=folder)
    assert done.returncode == 0, done.stderr
    return read_record(folder / "run.parquet")


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGSTOP], ids=["killed", "hanging"])
def test_a_page_lost_in_mid_run_costs_no_sample(how: signal.Signals, unwatched: Record, tmp_path: Path) -> None:
    (tmp_path / "plan.toml").write_text(long_plan(2))
    with watched(tmp_path, *OPTIONS) as run:
        until_it_moves(run.process)
        os.kill(run.page, how)
        status, errors = run.finished()
    assert status == 0, errors
    assert ("note: the page that watches has ended; the run goes on" in errors) == (how is signal.SIGKILL)
    assert_same(read_record(tmp_path / "run.parquet"), unwatched)


def test_a_browser_that_disappears_costs_no_sample(unwatched: Record, tmp_path: Path) -> None:
    found = executable()
    if found is None:
        pytest.skip("no Chromium is installed")
    (tmp_path / "plan.toml").write_text(long_plan(2))
    with watched(tmp_path, *OPTIONS) as run:
        os.kill(run.process.pid, signal.SIGSTOP)  # a run in lockstep may be over before a browser has started
        words = [found, "--headless", *arguments(), f"--user-data-dir={tmp_path / 'profile'}", run.address]
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        with subprocess.Popen(words, start_new_session=True, **quiet) as browser:
            try:
                wait_until(lambda: has_visitor(run.address))
                os.kill(run.process.pid, signal.SIGCONT)
                until_it_moves(run.process)
            finally:
                os.killpg(browser.pid, signal.SIGKILL)
        status, errors = run.finished()
    assert status == 0, errors
    assert_same(read_record(tmp_path / "run.parquet"), unwatched)


def until_it_moves(run: subprocess.Popen[str]) -> None:
    """Read what a run says until it moves on one of its two circles: on a busy computer the first is over unsaid."""
    assert run.stderr is not None
    while not re.search(r"run [12]/2", line := run.stderr.readline()):
        assert line, run.wait()


def has_visitor(address: str) -> bool:
    """Return whether a browser holds a connection to a page's server."""
    port = int(address.rpartition(":")[2].partition("/")[0])
    lines = Path("/proc/net/tcp").read_text().splitlines()[1:]
    return any(f"{port:04X}" == line.split()[1].partition(":")[2] and line.split()[3] == "01" for line in lines)


def wait_until(is_so: Callable[[], bool]) -> None:
    ends = time.monotonic() + TIMEOUT_S
    while not is_so():
        assert time.monotonic() < ends
        time.sleep(0.05)


def assert_same(record: Record, unwatched: Record) -> None:
    assert record.complete
    assert set(record.columns) == set(unwatched.columns)
    for name, values in unwatched.columns.items():
        np.testing.assert_array_equal(record.columns[name], values, err_msg=name)


def test_without_its_framework_the_page_is_refused_before_anything_moves(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(run_watched, "find_spec", lambda name: None)
    (tmp_path / "plan.toml").write_text(long_plan(1))
    done = called("hexdbb-run", "--plan", "plan.toml", "-o", "run.parquet", "--watch", folder=tmp_path)
    assert done.returncode == 2
    assert done.stderr == "error: --watch: NiceGUI is not installed (expected: pip install 'hexdbb[workbench]')\n"
    assert not (tmp_path / "run.parquet").exists()


@pytest.mark.parametrize("ends_first", [False, True])
def test_a_page_that_does_not_start_ends_the_run_before_anything_moves(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, ends_first: bool
) -> None:
    def begin_late(request: Request) -> Message:
        time.sleep(0.5 if ends_first else 0.0)
        return begin(request)

    monkeypatch.setattr(page_feed.sys, "executable", "/bin/false")
    monkeypatch.setattr(page_feed, "begin", begin_late)
    (tmp_path / "plan.toml").write_text(long_plan(1))
    done = called("hexdbb-run", "--plan", "plan.toml", "-o", "run.parquet", "--watch", folder=tmp_path)
    assert done.returncode == 1
    assert done.stderr == "error: --watch: the page did not start: it ended with status 1; nothing has moved\n"
    assert not (tmp_path / "run.parquet").exists()
