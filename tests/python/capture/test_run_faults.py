"""Every fault stops all six axes together and keeps what was captured; seen in the rig itself, over its bus.

`hexdbb-run` is a process of its own where it is killed, interrupted or runs out of disk. After the run the states of
the drives are read; a drive that was not stopped by then is stopped by the rig when its controller disconnects, which
its log shows.
"""

from __future__ import annotations

import os
import re
import select
import signal
import subprocess
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import can
import pyarrow as pa
import pytest
from tests.python.capture.conftest import PLAN, RunningRig

from hexdbb.capture.cia402 import DriveState
from hexdbb.record import Record, read_record, recover

RATE_HZ = 50.0
FAULT_S = 6.0
"""In the middle of the capture, counted from when the drives are enabled."""
DRIVES = list(range(1, 7))

STOPPED = "all six axes stopped"
SILENT = "does not answer, standstill not confirmed"
FAULTS = [
    # kind of fault, its node, message of the cause, message about the axes
    ("drive-fault:3={time}=0x2310", 3, r"node 3 \(slider 3\): object 6041:00 is \w+h, fault.*EMCY 2310h", STOPPED),
    (
        "following-error:1",
        1,
        r"node 1 \(slider 1\): object 60(41|64):00 (is .*(following error|EMCY 8611h|from its target)|fell .* target)",
        STOPPED,
    ),
    ("gauge-out-of-range", 7, r"node 7 \(gauge\): object 6150:01 is 03h, not valid, positive overload", STOPPED),
    ("gauge-break", 7, r"node 7 \(gauge\): object 6150:01 is 01h, not valid", STOPPED),
    ("limit-switch:6", 6, r"node 6 \(slider 6\): object 6041:00 is \w+h, quick stop active, EMCY 8612h", STOPPED),
    ("enable-lost:1", 1, r"node 1 \(slider 1\): object 6041:00 is \w+h, switch on disabled", STOPPED),
    ("mode-lost:4", 4, r"node 4 \(slider 4\): object 6061:00 is 0 \(expected 8", STOPPED),
    ("emcy:7", 7, r"node 7 \(gauge\): EMCY FF00h, error register 01h", STOPPED),
    (
        "node-missing:5",
        5,
        r"node 5 \(slider 5\): TPDO1 missing after 3 consecutive SYNCs",
        f"node 5 (slider 5): {SILENT}",
    ),
    ("boot-up:2", 2, r"node 2 \(slider 2\): heartbeat reports NMT state 0", f"node 2 (slider 2): {SILENT}"),
]


def incomplete(path: Path) -> Record:
    """Read the record after a fault; check that it holds good samples up to the fault and is marked incomplete."""
    record = read_record(path)
    assert not record.complete
    assert not path.with_name(path.name + ".journal").exists()
    assert len(record) > 50
    assert abs(record.columns["reading_um"]).max() < 1000.0
    return record


@pytest.mark.parametrize(("fault", "node", "cause", "axes"), FAULTS, ids=[row[0].partition(":")[0] for row in FAULTS])
def test_fault_while_capturing(
    fault: str,
    node: int,
    cause: str,
    axes: str,
    start_rig: Callable[..., object],
    run: Callable[..., subprocess.CompletedProcess[str]],
    tmp_path: Path,
) -> None:
    kind, _, value = fault.partition("={time}")
    with start_rig("--fault", f"{kind}@{FAULT_S}{value}") as rig:
        done = run("--bus", rig.bus, "--yes")
        others = [drive for drive in DRIVES if drive != node]
        assert rig.states(others) == [DriveState.QUICK_STOP_ACTIVE] * len(others)
        assert rig.velocities(others) == [0] * len(others)
        assert "no client on the bus" not in re.sub(rf"node {node}: .*", "", rig.log.read_text())
    assert done.returncode == 1, done.stderr
    message = done.stderr.splitlines()[-1]
    assert re.match(f"error: {cause}", message)
    assert axes in message
    stopped_s = float(re.search(r" at t = ([0-9.]+) s; ", message)[1])
    record = incomplete(tmp_path / "run.parquet")
    assert re.search(cause, record.metadata["incomplete_because"])
    assert f"{len(record)} samples kept" in message
    # The last good sample is the one before the fault was seen, at most the silence that was waited for earlier.
    assert stopped_s - 6 / RATE_HZ < record.columns["t_s"][-1] < stopped_s


def test_fault_is_handed_on_to_the_rig_that_is_started_for_the_run(
    run: Callable[..., subprocess.CompletedProcess[str]], tmp_path: Path
) -> None:
    done = run("--fault", f"node-missing:5@{FAULT_S}", "--seed", 2)
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1].startswith("error: node 5 (slider 5): TPDO1 missing after 3 consecutive SYNCs")
    incomplete(tmp_path / "run.parquet")


def test_one_answer_that_stays_out_costs_its_sample_and_nothing_else(
    start_rig: Callable[..., object], run: Callable[..., subprocess.CompletedProcess[str]], tmp_path: Path
) -> None:
    with start_rig("--fault", f"tpdo-missing:3@{FAULT_S}=1") as rig:
        done = run("--bus", rig.bus, "--yes")
    assert done.returncode == 0, done.stderr
    record = read_record(tmp_path / "run.parquet")
    assert record.complete
    gaps = [round(gap * RATE_HZ) for gap in record.columns["t_s"][1:] - record.columns["t_s"][:-1]]
    assert sorted(gaps)[-1] == 2  # the sample itself: its answer is waited for, and the next is its own again
    assert sorted(gaps)[-2] == 1


@pytest.mark.parametrize(
    ("fault", "cause"),
    [
        ("node-missing:2", r"node 2 \(slider 2\): no answer reading 1000:00"),
        ("node-missing:7", r"node 7 \(gauge\): no answer reading 1000:00"),
        ("gauge-unit", r"node 7 \(gauge\): object 6131:01 is FD010000h \(expected FA010000h, micrometre\)"),
        ("not-homed:4", r"node 4 \(slider 4\): object 6041:00 is \w+h, not homed"),
    ],
)
def test_what_is_wrong_before_motion_is_refused_and_nothing_moves(
    fault: str,
    cause: str,
    start_rig: Callable[..., object],
    run: Callable[..., subprocess.CompletedProcess[str]],
    tmp_path: Path,
) -> None:
    with start_rig("--fault", fault) as rig:
        done = run("--bus", rig.bus, "--yes")
        assert "OPERATION_ENABLED" not in rig.log.read_text()
    assert done.returncode == 1
    assert re.match(f"error: {cause}", done.stderr.splitlines()[-1])
    assert list(tmp_path.glob("run*")) == []


@pytest.fixture
def many_laps(tmp_path: Path) -> Path:
    """Return a plan that still runs when a signal arrives. One of 60 laps ended within 3 s, under load before it."""
    return plan_of(tmp_path / "many-laps.toml", laps=600)


def plan_of(path: Path, laps: int) -> Path:
    """Write the plan with so many laps a circle."""
    path.write_text(PLAN.replace("laps = 1", f"laps = {laps}"))
    return path


def wait_for_samples(process: subprocess.Popen[str], record: Path) -> None:
    """Wait until the journal holds more samples than a test asks of the record."""
    journal = record.with_name(record.name + ".journal")
    while rows_of(journal) <= 60:
        assert process.poll() is None, process.communicate()[1]
        time.sleep(0.02)


def rows_of(journal: Path) -> int:
    """Return the number of samples in the whole batches of a journal."""
    rows = 0
    with suppress(OSError, StopIteration, pa.ArrowInvalid), pa.ipc.open_stream(journal.read_bytes()) as stream:
        while True:
            rows += stream.read_next_batch().num_rows
    return rows


@pytest.mark.parametrize(
    ("number", "cause"),
    [
        (signal.SIGINT, "interrupted by the user"),
        (signal.SIGTERM, "interrupted by the user"),
        (signal.SIGQUIT, r"interrupted by the user \(SIGQUIT\)"),
        (signal.SIGHUP, r"interrupted, the terminal was closed \(SIGHUP\)"),
    ],
)
def test_interrupted_run_stops_and_keeps(
    number: signal.Signals,
    cause: str,
    start_rig: Callable[..., object],
    command: Callable[..., list[str]],
    many_laps: Path,
    tmp_path: Path,
) -> None:
    with start_rig() as rig:
        line = command("--bus", rig.bus, "--yes", "--plan", many_laps)
        # Tests that are run by nohup ignore a closed terminal, and so does what they start: a run goes on then.
        process = subprocess.Popen(["env", "--default-signal", *line], stderr=subprocess.PIPE, text=True)
        wait_for_samples(process, tmp_path / "run.parquet")
        process.send_signal(number)
        _, said = process.communicate(timeout=30)
        assert rig.states(DRIVES) == [DriveState.QUICK_STOP_ACTIVE] * 6
        assert rig.velocities(DRIVES) == [0] * 6
        assert "no client on the bus" not in rig.log.read_text()
    assert process.returncode == 1
    assert re.match(f"error: hexdbb-run: {cause} at t = .*; {STOPPED}; ", said.splitlines()[-1])
    record = read_record(tmp_path / "run.parquet")
    assert not record.complete
    assert len(record) > 10


def test_impatient_user_still_sees_the_cause_and_what_was_kept(
    command: Callable[..., list[str]], many_laps: Path, tmp_path: Path
) -> None:
    line = command("--plan", many_laps, "--seed", 1)
    process = subprocess.Popen(line, stderr=subprocess.PIPE, text=True)
    wait_for_samples(process, tmp_path / "run.parquet")
    while process.poll() is None and process.stderr is not None:
        process.send_signal(signal.SIGINT)
        if select.select([process.stderr], [], [], 0.05)[0] and "error: " in (said := process.stderr.readline()):
            break
    process.communicate(timeout=30)
    kept = r"\d+ samples kept in .*run\.parquet, marked incomplete"
    assert re.match(f"error: hexdbb-run: interrupted by the user at t = .*; {STOPPED}; {kept}", said)


def test_ctrl_c_in_the_terminal_reaches_the_controller_and_not_its_rig(
    command: Callable[..., list[str]], many_laps: Path, tmp_path: Path
) -> None:
    line = command("--plan", many_laps, "--seed", 1)
    process = subprocess.Popen(line, stderr=subprocess.PIPE, text=True, start_new_session=True)
    wait_for_samples(process, tmp_path / "run.parquet")
    os.killpg(process.pid, signal.SIGINT)
    _, said = process.communicate(timeout=30)
    assert process.returncode == 1
    assert re.match(f"error: hexdbb-run: interrupted by the user at t = .*; {STOPPED}; ", said.splitlines()[-1])


def test_emergency_cut_short_stops_the_axes_and_keeps_cause_and_record(
    start_rig: Callable[..., object], command: Callable[..., list[str]], many_laps: Path, tmp_path: Path
) -> None:
    with start_rig() as rig:
        line = command("--bus", rig.bus, "--yes", "--plan", many_laps)
        process = subprocess.Popen(line, stderr=subprocess.PIPE, text=True)
        wait_for_samples(process, tmp_path / "run.parquet")
        rig.observer.send(can.Message(arbitration_id=0x083, data=b"\x10\x23", is_extended_id=False))
        _, said = process.communicate(timeout=60)
        assert rig.states(DRIVES) == [DriveState.QUICK_STOP_ACTIVE] * 6
    assert process.returncode == 1
    cause = rf"node 3 \(slider 3\): EMCY 2310h, cut short to 2 bytes \(10 23\) \(expected none\) at t = .*; {STOPPED}; "
    assert re.match(f"error: {cause}", said.splitlines()[-1])
    assert re.match(cause, incomplete(tmp_path / "run.parquet").metadata["incomplete_because"] + "; ")


def test_full_disk_stops_the_axes_and_leaves_a_journal_to_recover(
    start_rig: Callable[..., object], command: Callable[..., list[str]], tmp_path: Path
) -> None:
    with start_rig() as rig:
        line = command("--bus", rig.bus, "--yes", "--plan", plan_of(tmp_path / "plan.toml", laps=60))
        # No file beyond 1000 blocks: the system's own limit stands in for a full disk. The targets of 60 laps take 850,
        # and of more laps do not fit, which is said before anything moves.
        limited = ["bash", "-c", 'ulimit -f 1000; exec "$@"', "bash", *line]
        done = subprocess.run(limited, capture_output=True, text=True, timeout=120)
        assert rig.states(DRIVES) == [DriveState.QUICK_STOP_ACTIVE] * 6
        assert "no client on the bus" not in rig.log.read_text()
    assert done.returncode == 1
    journal = tmp_path / "run.parquet.journal"
    said = done.stderr.splitlines()[-1]
    assert re.match(rf"error: {re.escape(str(journal))}: cannot be written: .* at t = .*; {STOPPED}$", said)
    record = recover(journal)
    assert not record.complete
    assert len(record) > 500


def test_killed_controller_leaves_standing_axes_and_a_journal_to_recover(
    start_rig: Callable[..., object], command: Callable[..., list[str]], many_laps: Path, tmp_path: Path
) -> None:
    with start_rig() as rig:
        line = command("--bus", rig.bus, "--yes", "--plan", many_laps)
        process = subprocess.Popen(line, stderr=subprocess.DEVNULL)
        wait_for_samples(process, tmp_path / "run.parquet")
        process.kill()
        process.wait(timeout=10)
        assert rig.states(DRIVES) == [DriveState.QUICK_STOP_ACTIVE] * 6
        assert len(re.findall(r"node \d: stopped at .* QUICK_STOP_ACTIVE", rig.log.read_text())) == 6
    record = recover(tmp_path / "run.parquet.journal")
    assert not record.complete
    assert len(record) > 50


def test_rig_that_dies_ends_the_run_and_keeps_what_was_captured(
    rig_process: tuple[RunningRig, subprocess.Popen[str]],
    command: Callable[..., list[str]],
    many_laps: Path,
    tmp_path: Path,
) -> None:
    rig, serving = rig_process
    line = command("--bus", rig.bus, "--yes", "--plan", many_laps)
    process = subprocess.Popen(line, stderr=subprocess.PIPE, text=True)
    wait_for_samples(process, tmp_path / "run.parquet")
    serving.kill()
    _, said = process.communicate(timeout=60)
    assert process.returncode == 1
    message = said.splitlines()[-1]
    assert re.match(r"error: bus: ", message)
    assert "the drives stop on their own" in message or SILENT in message
    record = read_record(tmp_path / "run.parquet")
    assert not record.complete
    assert len(record) > 0
