"""Cycle times of a run without a page, with one open in headless Chromium, and with one that hangs.

``python -m tests.browser.watch_times [ROUNDS [--realtime]]``: runs a plan of two laps at 250 Hz on the simulated rig in
each of the three ways, in turns, and prints a table. Each run is a process of its own; the histogram is the loop's. In
lockstep, unless asked otherwise: the next SYNC when all nodes have answered, so that whatever holds up the loop shows,
and a computer that does much else does not stop the run.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, sync_playwright
from tests.browser.chromium import HEIGHT, arguments, executable
from tests.python.live.watched import long_plan, page_of

from hexdbb.capture.buses import SimulatedRig, opened_bus, running_clock
from hexdbb.capture.cycle_times import BIN_S
from hexdbb.capture.page_feed import watched_by_page
from hexdbb.capture.request import Request, RunProgress, prepare
from hexdbb.capture.session import measure
from hexdbb.cli.run import SIMULATED_SILENT_AFTER
from hexdbb.errors import HexdbbError
from hexdbb.plan import load_plan

RATE_HZ = 250.0
WAYS = ("without a page", "page open", "page hanging")
LOCKSTEP, REAL_TIME = "--lockstep", "--realtime"
SHARES = (0.5, 0.99, 0.999)


def run(folder: str, with_page: bool, lockstep: bool) -> None:
    """Measure once; print the page's address, then the histogram."""
    plan = load_plan(str(Path(folder) / "plan.toml"))
    record = Path(folder) / "run.parquet"
    request = Request(plan, plan.machine_file(), "plan.toml", 1.0 / RATE_HZ, record, overwrite=True)
    request, progress = replace(request, silent_after=SIMULATED_SILENT_AFTER), RunProgress()

    def say(text: str) -> None:
        print(text, flush=True)

    def drive() -> None:
        programme = prepare(request)
        with (
            opened_bus(SimulatedRig(seed=5), request.machine) as bus,
            running_clock(lockstep, request.cycle_s, progress) as clock,
        ):
            measure(request, programme, bus, clock, progress)

    try:
        if with_page:
            with watched_by_page(request, progress, False, say):
                drive()
        else:
            drive()
    except HexdbbError as error:
        sys.stderr.write(f"{error}\n")
    times = progress.times
    assert times is not None
    counts = {index: count for index, count in enumerate(times.times) if count}
    say(json.dumps({"counts": counts, "longest_s": times.longest_s, "missed": progress.missed}))


def measured(folder: str, way: str, pace: str, browser: Browser) -> dict[str, Any]:
    """Return the histogram of one run."""
    words = [sys.executable, "-m", "tests.browser.watch_times", "--run", folder, way, pace]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        if way == WAYS[0]:
            return json.loads(process.stdout.readline())
        address, page = process.stdout.readline().strip(), page_of(process.pid)
        context = browser.new_page(viewport={"width": 1440, "height": HEIGHT})
        context.goto(address)
        if way == WAYS[2]:
            os.kill(page, signal.SIGSTOP)
        histogram = json.loads(process.stdout.readline())
        context.close()
        os.kill(page, signal.SIGKILL)
        return histogram


def row(way: str, found: list[dict[str, Any]]) -> str:
    """Return a row of the table."""
    counts: Counter[int] = Counter()
    for each in found:
        counts.update({int(index): count for index, count in each["counts"].items()})
    total, limits, cumulated = sum(counts.values()), [], 0
    for index in sorted(counts):
        cumulated += counts[index]
        while len(limits) < len(SHARES) and cumulated >= SHARES[len(limits)] * total:
            limits.append(f"{1e3 * BIN_S * (index + 1):.1f}")
    longest_ms = 1e3 * max(each["longest_s"] for each in found)
    return f"| {way} | {total:,} | {' | '.join(limits)} | {longest_ms:.1f} | {sum(each['missed'] for each in found)} |"


def main(rounds: int, pace: str) -> None:
    """Print the table."""
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as driver:
        (Path(folder) / "plan.toml").write_text(long_plan(2))
        browser = driver.chromium.launch(executable_path=executable(), args=arguments())
        found: dict[str, list[dict[str, Any]]] = {way: [] for way in WAYS}
        for _ in range(rounds):
            for way in WAYS:
                found[way].append(measured(folder, way, pace, browser))
        browser.close()
    print("| | cycles | half within, ms | 99 % | 99.9 % | longest | SYNCs missed |")
    print("|---|---|---|---|---|---|---|")
    for way in WAYS:
        print(row(way, found[way]))


if __name__ == "__main__":
    words = sys.argv[1:]
    if words[:1] == ["--run"]:
        run(words[1], words[2] != WAYS[0], words[3] == LOCKSTEP)
    else:
        main(int(words[0]) if words else 3, REAL_TIME if REAL_TIME in words else LOCKSTEP)
