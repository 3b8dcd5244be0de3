"""`hexdbb rig` as a command: bad input, the truth it writes, EDS files of other makers, its end."""

from __future__ import annotations

import os
import re
import socket
import struct
import subprocess
import sys
import time
from pathlib import Path

import pytest
from click.testing import CliRunner
from tests.programs import called

from hexdbb.cli import cli
from hexdbb.files.validation import load_toml
from hexdbb.machine import shipped
from hexdbb.rig.truth import TruthFile, random_truth

RIG = [sys.executable, "-c", "from hexdbb.cli import main; main()", "rig"]


def ended(*arguments: str) -> tuple[int, str, str]:
    done = called("hexdbb", "rig", *arguments)
    return done.returncode, done.stdout, done.stderr


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--truth", "nowhere.toml"], "nowhere.toml: no such file"),
        (["--machine", "nowhere.toml"], "nowhere.toml: no such file"),
        (["--fault", "node-missing:9"], "--fault node-missing:9: node 9 (expected one of [1, 2, 3, 4, 5, 6, 7])"),
        (["--fault", "drive-fault:7"], "--fault drive-fault:7: node 7 (expected one of [1, 2, 3, 4, 5, 6])"),
        (["--write-truth", "no/such/folder/truth.toml"], "cannot be written: No such file or directory"),
    ],
)
def test_bad_input_is_one_line_and_status_2(arguments, says):
    status, out, err = ended(*arguments)
    assert (status, out) == (2, "")
    assert says in err
    assert err.count("\n") == 1


def test_taken_port_is_named():
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        status, out, err = ended("--port", str(port))
    assert (status, out) == (2, "")
    assert err == f"error: --port {port}: Address already in use (expected a free port, or 0)\n"


def test_start_pose_out_of_reach_is_named(truth_file):
    status, _, err = ended("--truth", truth_file("[start]\nposition_mm = [0, 0, 900]\n"))
    assert status == 2
    assert "start pose [0.0, 0.0, 900.0] mm: leg " in err


def test_written_truth_is_the_hidden_machine(rig_process, tmp_path):
    path = tmp_path / "hidden.toml"
    with rig_process("--seed", "11", "--write-truth", str(path)):
        assert load_toml(path, TruthFile) == random_truth(11)


def test_help_names_every_fault():
    shown = CliRunner().invoke(cli, ["rig", "--help"])
    assert shown.exit_code == 0
    assert re.search(r"gauge-frozen +the reading no longer changes", shown.output)


def _machine_with(folder: Path, eds_text: str) -> Path:
    (folder / "other.eds").write_text(eds_text, encoding="cp1252")
    text = shipped("sp120.toml").read_text(encoding="utf-8")
    machine = folder / "machine.toml"
    machine.write_text(text.replace('"hexglider_drive.eds"', '"other.eds"'), encoding="utf-8")
    return machine


def _without(text: str, *indices: str) -> str:
    for index in indices:
        text = re.sub(rf"\[{index}(sub[0-9A-F]+)?\]\n(?:[^\[\n].*\n|\n)*", "", text)
    return text


def test_drive_of_an_eds_without_optional_objects_works(start, tmp_path):
    text = shipped("eds", "hexglider_drive.eds").read_text(encoding="ascii")
    lean = _without(text, "60C2", "605A", "6085", "607F", "1029", "1003").replace(
        "VendorName=hexdbb", "VendorName=Größe"
    )
    controller = start("--machine", str(_machine_with(tmp_path, lean)))
    at = controller.ready()
    for step in range(1, 51):
        controller.cycle(0x0F, [count + 40 * step for count in at])
    for _ in range(10):
        answers = controller.cycle(0x0F, [count + 2000 for count in at])
    assert [struct.unpack_from("<i", answers[n], 2)[0] for n in range(1, 7)] == [count + 2000 for count in at]


def test_drive_of_an_eds_without_a_statusword_is_refused(tmp_path):
    text = shipped("eds", "hexglider_drive.eds").read_text(encoding="ascii")
    status, _, err = ended("--machine", str(_machine_with(tmp_path, _without(text, "6041"))))
    assert status == 2
    assert "other.eds: object 6041h:00 is missing (expected for node 1)" in err


def test_rig_ends_with_the_process_that_started_it():
    parent = (
        "import subprocess, sys\n"
        f"rig = subprocess.Popen({[*RIG, '--exit-with-parent']!r}, stdout=subprocess.PIPE, text=True)\n"
        "rig.stdout.readline()\n"
        "print(rig.pid, flush=True)\n"
        "import os; os._exit(0)\n"
    )
    done = subprocess.run([sys.executable, "-c", parent], capture_output=True, text=True, check=True, timeout=60)
    pid = int(done.stdout)
    end = time.monotonic() + 20.0
    while time.monotonic() < end and Path(f"/proc/{pid}").exists() and _running(pid):
        time.sleep(0.05)
    assert not _running(pid)


def _running(pid: int) -> bool:
    try:
        os.kill(pid, 0)
        state = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()[0]
    except (ProcessLookupError, FileNotFoundError):
        return False
    return state != "Z"


def test_seed_with_a_truth_file_changes_its_noise_alone(rig_process, truth_file, tmp_path):
    path = truth_file("seed = 3\n[geometry]\nleg_length_um = [1, 2, 3, 4, 5, 6]\n")
    used = tmp_path / "used.toml"
    with rig_process("--truth", path, "--seed", "8", "--write-truth", str(used)):
        given, truth = load_toml(path, TruthFile), load_toml(used, TruthFile)
    assert (given.seed, truth.seed) == (3, 8)
    assert truth.geometry == given.geometry


def test_truth_is_written_without_serving(tmp_path: Path) -> None:
    words = [sys.executable, "-m", "hexdbb.cli", "rig", "--seed", "3", "--no-serve"]
    done = subprocess.run([*words, "--write-truth", "truth.toml"], cwd=tmp_path, capture_output=True, timeout=60)
    assert (done.returncode, done.stdout) == (0, b"")
    assert (tmp_path / "truth.toml").is_file()
    refused = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert refused.returncode == 2
    assert "--write-truth" in refused.stderr
