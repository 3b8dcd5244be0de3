"""Real time that explains itself: whose fault a fault is, which rate is safe, what the record keeps of it."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from tests.faults.messages import Way
from tests.faults.proxy import proxied
from tests.faults.runs import (
    RATE_HZ,
    RECORD,
    command_line,
    never_waiting,
    options,
    prepared,
    rig_in_process,
    rig_options,
)
from tests.faults.transformations import FOREVER, Rule, drop
from tests.programs import called
from tests.python.capture.scripted_bus import DRIVES, GAUGE, ScriptedBus, at_rest, axes_on
from tests.rigs import rig_in_thread

from hexdbb.capture.latency import SHARES, Histogram, Latency
from hexdbb.capture.lateness import PERIOD_S, Lateness
from hexdbb.capture.motion import MotionFaultError
from hexdbb.capture.real_time_check import RATES_HZ, judged
from hexdbb.capture.realtime import FIFO_PRIORITY, give_way, real_time_process
from hexdbb.capture.round_trips import measured_latency
from hexdbb.capture.transport import open_bus
from hexdbb.errors import RunError
from hexdbb.record import read_record

STALL_S = 0.1


class FakeComputer:
    """The clock of a computer that is `late_s` late after every sleep and computes for `own_s` meanwhile."""

    def __init__(self, late_s: float = 0.0, own_s: float = 0.0) -> None:
        self.now_s = self.used_s = 0.0
        self.late_s, self.own_s = late_s, own_s

    def sleep(self, seconds: float) -> None:
        self.now_s += seconds + self.late_s
        self.used_s += self.own_s

    def lateness(self) -> Lateness:
        measured = Lateness(self.sleep, lambda: self.now_s, lambda: self.used_s)
        for _ in range(3):
            measured.wake_once()
        return measured


def filled(times_s: list[float]) -> Histogram:
    histogram = Histogram()
    for each in times_s:
        histogram.take(each)
    return histogram


def test_percentiles_are_those_of_the_times_to_the_width_of_a_bin() -> None:
    rng = random.Random(1)
    times_s = [1e-3 * rng.lognormvariate(0.0, 2.0) for _ in range(5000)]
    histogram = filled(times_s)
    for share in SHARES.values():
        exact = float(np.quantile(times_s, share, method="inverted_cdf"))
        assert exact * 0.999 <= histogram.percentile_s(share) <= exact * 2 ** (1 / 16) * 1.001
    assert histogram.percentile_s(1.0) == max(times_s)
    assert histogram.share_above(1e-3) == pytest.approx(np.mean(np.array(times_s) > 1e-3), abs=0.02)
    assert Histogram().percentile_s(0.5) == 0.0


def test_a_wake_up_is_as_late_as_the_sleep_was_too_long() -> None:
    measured = FakeComputer(late_s=0.050, own_s=0.001).lateness()
    worst = measured.worst_within(10.0)
    assert worst.late_s == pytest.approx(0.050)
    assert worst.own_s == pytest.approx(0.001)
    assert measured.worst_s == pytest.approx(0.050)


def test_a_wake_up_that_is_still_to_come_counts_and_old_ones_do_not() -> None:
    computer = FakeComputer(late_s=0.050)
    measured = computer.lateness()
    computer.now_s += 10.0 + PERIOD_S
    assert measured.worst_within(1.0).late_s == pytest.approx(10.05, abs=0.02)
    computer.late_s = 0.0
    measured.wake_once()
    assert measured.worst_within(1.0).late_s == 0.0


def message_of(silent: tuple[int, ...], computer: FakeComputer) -> str:
    """Return the message of a run in real time in which nodes fall silent, on a computer."""
    bus = ScriptedBus()
    axes = axes_on(bus)
    axes.read_positions()
    axes.enable()
    bus.silent = set(silent)
    watch = axes._watch
    watch.real_time, watch.computer = True, computer.lateness()
    with pytest.raises(MotionFaultError) as caught:
        axes.follow(at_rest(20), NoRows(), {})
    return str(caught.value)


class NoRows:
    def keep(self, row: object, feedback: object) -> None:
        pass

    def settle(self, paired: bool, held: int) -> None:
        pass

    def pause(self) -> None:
        pass


ALL = (*DRIVES, GAUGE)


@pytest.mark.parametrize(
    ("silent", "computer", "begins", "names"),
    [
        (ALL, FakeComputer(), "bus: no node answered 3", "this computer was at most 0.50 ms late meanwhile"),
        (ALL, FakeComputer(0.060), "this computer: was 60.0 ms late (bus: no node answered 3", "(expected TPDO1"),
        (
            ALL,
            FakeComputer(0.060, own_s=0.055),
            "bus: no node answered 3",
            "this program computed for 55.0 ms meanwhile",
        ),
        ((3,), FakeComputer(), "node 3 (slider 3): TPDO1 missing", "this computer was at most 0.50 ms late meanwhile"),
        ((3,), FakeComputer(0.060), "node 3 (slider 3): TPDO1 missing", "this computer was 60.0 ms late meanwhile"),
    ],
)
def test_the_message_blames_the_computer_or_the_node(
    silent: tuple[int, ...], computer: FakeComputer, begins: str, names: str
) -> None:
    message = message_of(silent, computer)
    assert message.startswith(begins), message
    assert names in message


@pytest.mark.parametrize(
    ("silent", "computer", "begins"),
    [
        (ALL, FakeComputer(0.060), "this computer: was 60.0 ms late (every node: TPDO1 missing"),
        (ALL, FakeComputer(), "every node: TPDO1 missing"),
        ((3,), FakeComputer(0.060), "node 3 (slider 3): TPDO1 missing"),
    ],
)
def test_the_message_blames_the_right_one_before_motion_too(
    silent: tuple[int, ...], computer: FakeComputer, begins: str
) -> None:
    bus = ScriptedBus()
    axes = axes_on(bus)
    axes.read_positions()
    bus.silent = set(silent)
    axes._watch.real_time, axes._watch.computer = True, computer.lateness()
    with pytest.raises(RunError) as caught:
        axes.enable()
    assert str(caught.value).startswith(begins)


@pytest.mark.parametrize("computer", [FakeComputer(), FakeComputer(0.060)])
def test_that_silent_nodes_are_programs_of_this_computer_is_said(computer: FakeComputer) -> None:
    bus = ScriptedBus()
    axes = axes_on(bus)
    axes.read_positions()
    axes._watch.real_time, axes._watch.computer, axes._watch.nodes_here = True, computer.lateness(), True
    bus.silent = {3}
    with pytest.raises(RunError) as caught:
        axes.enable()
    assert "late meanwhile; the nodes are simulated on this computer, which may be too busy" in str(caught.value)


def test_a_node_whose_answers_a_proxy_drops_is_blamed_in_a_run_in_real_time() -> None:
    message = message_of_run(lambda process: None, [Rule(0x183, Way.TO_CONTROLLER, drop, 2.0, FOREVER)])
    assert message.startswith("error: node 3 (slider 3): TPDO1 missing after 3 consecutive SYNCs"), message
    assert "late meanwhile" in message or "computed for" in message


def test_a_computer_that_stops_the_controller_is_blamed() -> None:
    def stall(process: subprocess.Popen[str]) -> None:
        process.send_signal(signal.SIGSTOP)
        time.sleep(20.0 * STALL_S)
        process.send_signal(signal.SIGCONT)

    message = message_of_run(stall, [])
    assert message.startswith("error: this computer: was "), message
    assert " late (" in message, "the fault that came of it is named too"


def message_of_run(disturb: Callable[[subprocess.Popen[str]], None], rules: list[Rule]) -> str:
    """Return the error of a run in real time that is disturbed when the axes move."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        truth = prepared(folder)
        pace, rig = never_waiting(), rig_in_process(*rig_options(truth, (), 1))
        with pace, rig as port, proxied(port, rules, 1 / RATE_HZ) as proxy:
            words = command_line(options(folder, proxy.bus, False))
            process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            while process.poll() is None and (proxy.log.since_enabled or 0) < RATE_HZ:
                time.sleep(0.01)
            disturb(process)
            _, err = process.communicate(timeout=60.0)
    return next(line for line in err.splitlines() if line.startswith("error: "))


def late(times_s: list[float], answered_s: list[float] | None = None) -> Latency:
    return Latency(filled(times_s), filled(answered_s or []))


ON_TIME = [1e-4] * 10_000


@pytest.mark.parametrize(
    ("latency", "rate_hz", "safe", "slower", "reason"),
    [
        (late(ON_TIME), 250.0, True, 250, "250 Hz is safe"),
        (late(ON_TIME + [0.003] * 5), 250.0, True, 250, "250 Hz is safe"),
        (late(ON_TIME + [0.003] * 50), 250.0, False, 125, "0.5% of wake-ups later than half a cycle, 2.0 ms"),
        (late([*ON_TIME, 0.08]), 250.0, False, None, "a delay of 80.0 ms, where drives stop after 100.0 ms"),
        (late(ON_TIME, [0.001] * 900 + [0.005] * 100), 250.0, False, 125, "10.0% of answers later than 3.0 ms"),
    ],
)
def test_a_rate_is_judged_by_lateness_and_answers(
    latency: Latency, rate_hz: float, safe: bool, slower: int | None, reason: str
) -> None:
    verdict = judged(latency, rate_hz, 0.1)
    assert verdict.safe == safe
    assert verdict.safe_rate_hz == slower
    assert reason in verdict.said


def test_every_rate_that_is_proposed_fits_the_drives_interpolation_period() -> None:
    from hexdbb.capture.settings import interpolation_period

    for rate_hz in RATES_HZ:
        interpolation_period(1.0 / rate_hz)


@pytest.mark.parametrize(("latency", "status"), [(late(ON_TIME), 0), (late([*ON_TIME, 0.08]), 1)])
def test_check_realtime_exits_with_the_verdict(latency: Latency, status: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("hexdbb.cli.check_realtime.measured_latency", lambda *_: (latency, {}))
    done = called("hexdbb", "check-realtime", "--rate", 250)
    assert done.returncode == status
    assert "late by 0.10 ms (median), " in done.stdout
    assert ("250 Hz is safe" in done.stdout) == (status == 0)
    assert ("error: 250 Hz is not safe: a delay of 80.0 ms" in done.stderr) == (status == 1)
    assert ("To change" in done.stdout) == (status == 1)


def test_nodes_are_asked_in_turn_and_silent_ones_are_counted() -> None:
    with rig_in_thread("--seed", 1) as port, open_bus(f"socketcand:127.0.0.1:{port}", 1_000_000) as bus:
        latency, unanswered = measured_latency(20.0, 1.0, bus, (1, 7, 99))
    assert unanswered[99] > 0
    assert latency.answered.count + sum(unanswered.values()) == latency.late.count
    assert latency.answered.count > 0


def test_helpers_give_way_to_the_loop() -> None:
    found: list[int] = []

    def helper() -> None:
        give_way()
        inherited = threading.Thread(target=lambda: found.append(os.sched_getparam(0).sched_priority))
        inherited.start()
        inherited.join()

    with real_time_process() as refused:
        thread = threading.Thread(target=helper)
        thread.start()
        thread.join()
    assert found == [0 if any("SCHED_FIFO" in each for each in refused) else FIFO_PRIORITY - 1]


def test_a_record_in_real_time_keeps_latencies_and_the_look_before_motion(tmp_path: Path) -> None:
    truth = prepared(tmp_path)
    with rig_in_process(*rig_options(truth, (), 1)) as port:
        words = command_line(options(tmp_path, f"socketcand:127.0.0.1:{port}", False))
        done = subprocess.run(words, capture_output=True, text=True, timeout=60.0)
    record = read_record(tmp_path / RECORD)  # incomplete where this computer stalled
    for name in ("sync_late_ms", "answers_after_ms"):
        percentiles = list(record.metadata["latency"][name].values())
        assert percentiles == sorted(percentiles)
        assert len(percentiles) == 4
    assert any(note.startswith("real time: SYNC late by") and "50 Hz is" in note for note in record.metadata["notes"])
    if done.returncode == 0:
        assert done.stdout.splitlines()[-1].startswith("real time: SYNC late by ")
