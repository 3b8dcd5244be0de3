"""The engine inside a motion controller: LinuxCNC drives circles with the module, the true machine answers.

Circles are G-code, planned and interpolated by LinuxCNC; the joints of every servo period move the independent truth.
The compensation comes from a diagnosis of that machine by its noisy readings; one of the circles it has never seen.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from tests.linuxcnc.halrun import halrun
from tests.linuxcnc.machine import true_machine, write_compensation
from tests.linuxcnc.module import built_module
from tests.linuxcnc.program import CIRCLES, SHORT_MOVES_TAG, Circle, arcs, program
from tests.linuxcnc.readings import Roundness, measured_paths, roundness
from tests.linuxcnc.sandbox import is_installed, why_not
from tests.linuxcnc.session import PERIOD_S, Session, read_samples, run_linuxcnc

from hexdbb.machine import shipped_machine
from hexdbb.rig.truth import TruthFile

# `.ci/run` installs LinuxCNC and says so: a test that is skipped all the same would not be noticed there.
MUST_RUN = os.environ.get("HEXDBB_LINUXCNC") == "ON" and not is_installed()
pytestmark = pytest.mark.skipif(why_not() is not None and not MUST_RUN, reason=str(why_not()))


@dataclass(frozen=True)
class Made:
    """What the runs share."""

    module: Path
    truth: TruthFile
    compensation: Path


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Made:
    truth, path = true_machine(), tmp_path_factory.mktemp("linuxcnc") / "sp120.hexcomp"
    write_compensation(truth, path)
    return Made(built_module(), truth, path)


@pytest.fixture(scope="module")
def session(made: Made, tmp_path_factory: pytest.TempPathFactory) -> Session:
    return run_linuxcnc(tmp_path_factory.mktemp("run") / "work", made.module, made.compensation, program())


@pytest.fixture(scope="module")
def measured(made: Made, session: Session) -> dict[tuple[Circle, bool], Roundness]:
    paths = measured_paths(session, arcs(), made.truth, shipped_machine())
    tags = {(arc.circle, arc.is_compensated, arc.direction): arc.tag for arc in arcs()}
    return {
        (circle, on): roundness(paths[tags[circle, on, 1]], paths[tags[circle, on, -1]])
        for circle in CIRCLES
        for on in (False, True)
    }


@pytest.mark.parametrize("circle", CIRCLES, ids=lambda circle: circle.name)
def test_compensation_makes_circles_round(measured: dict[tuple[Circle, bool], Roundness], circle: Circle) -> None:
    before, after = measured[circle, False], measured[circle, True]
    assert before.rms > 5e-3
    assert before.rms > 25.0 * after.rms
    assert before.peak_to_valley > 10.0 * after.peak_to_valley
    assert before.hysteresis > 3.0 * after.hysteresis


def test_joints_lead_back_to_the_pose_they_were_asked_for(session: Session) -> None:
    assert session.columns["active_part"][-1] == 1.0
    assert session.columns["largest_correction_mm"][-1] > 0.01
    np.testing.assert_allclose(session.actual, session.commanded, atol=2e-5)


def test_nothing_jumps_when_compensation_is_switched_on(session: Session) -> None:
    part = session.columns["active_part"]
    fading = np.flatnonzero((part > 0.0) & (part < 1.0))
    assert len(fading) == 499
    stretch = session.sliders_mm[fading[0] - 10 : fading[-1] + 10]
    assert np.abs(stretch[-1] - stretch[0]).max() > 0.01
    # The last arc is slowed down still when it begins: steps from period to period change by that, and by no more.
    assert np.abs(np.diff(stretch, n=2, axis=0)).max() < 1e-3


def test_end_points_looked_at_are_not_motion(session: Session) -> None:
    moving = session.sliders_mm[session.columns["tag"] == SHORT_MOVES_TAG]
    play_mm = 4e-3
    assert np.abs(np.diff(moving, n=2, axis=0)).max() < play_mm


def test_every_pose_was_reached(session: Session) -> None:
    assert session.columns["refused"].max() == 0
    assert set(session.columns["iterations"][session.columns["tag"] > 0]) <= {1.0, 2.0, 3.0, 4.0}
    assert PERIOD_S * 1e9 > np.median(session.columns["inverse_ns"]) > 0


def test_an_end_point_out_of_reach_is_refused_before_the_move(made: Made, tmp_path: Path) -> None:
    beyond = "G21 G90 G61\nM68 E0 Q0\nG1 F6000 X130 Y130 Z330\nM2\n"
    with pytest.raises(RuntimeError) as refused:
        run_linuxcnc(tmp_path / "work", made.module, made.compensation, beyond)
    assert "fails kinematicsInverse" in str(refused.value)
    assert "hexdbb_kins: joint 4: unreachable" in str(refused.value)
    columns = read_samples(tmp_path / "work" / "samples.txt")
    home = [0.0, 0.0, 260.0, 0.0, 0.0, 0.0]
    assert [columns[f"pose_{axis}"][-1] for axis in "xyzabc"] == pytest.approx(home, abs=1e-4)


def test_without_its_functions_in_the_thread_nothing_is_compensated(made: Made, tmp_path: Path) -> None:
    short = "G21 G90 G61\nM64 P0\nG0 X10\nG4 P0.8\nM2\n"
    with pytest.raises(RuntimeError, match=r"no compensation: hexdbb-kins\.begin does not run"):
        run_linuxcnc(tmp_path / "work", made.module, made.compensation, short, left_out="addf hexdbb-kins.")
    columns = read_samples(tmp_path / "work" / "samples.txt")
    assert columns["slider_1_mm"][-1] > 100.0
    assert columns["active_part"].max() == 0.0
    assert columns["largest_correction_mm"].max() == 0.0


def load(made: Made, work: Path, words: str, text: str | None = None) -> tuple[int, str]:
    """Load the module in halrun beside a compensation file of that text; give the exit status and what was printed."""
    work.mkdir()
    (work / "sp120.hexcomp").write_text(made.compensation.read_text() if text is None else text)
    done = halrun(work, made.module, f"loadrt hexdbb_kins {words}\nshow pin hexdbb-kins\nshow funct\n")
    return done.returncode, done.stdout + done.stderr


def value(printed: str, pin: str) -> str:
    """Value of a pin as `show pin` prints it."""
    (line,) = (line.split() for line in printed.splitlines() if line.endswith(f" hexdbb-kins.{pin}"))
    return line[-2]


def test_module_loads_and_has_its_pins(made: Made, tmp_path: Path) -> None:
    status, printed = load(made, tmp_path / "work", "compensation=sp120.hexcomp")
    assert status == 0, printed
    assert value(printed, "loaded") == "TRUE"
    assert value(printed, "active-part") == "0"
    assert value(printed, "enable") == "FALSE"
    names = ["status", "slider", "refused", "iterations", "largest-correction", "pose-status", "pose-residual"]
    for name in (*names, "temperature", "temperature-valid", *(f"correction.{k}" for k in range(6))):
        assert value(printed, name)
    assert "hexdbb-kins.begin" in printed
    assert "hexdbb-kins.end" in printed


@pytest.mark.parametrize(
    ("change", "words", "expected"),
    [
        (lambda text: text[: len(text) // 2], "", "truncated: sp120.hexcomp: "),
        (lambda text: text.replace("longer = ", "longer = -", 1), "", "altered: sp120.hexcomp: "),
        (lambda text: text.replace("compensation/1", "compensation/9"), "", "later_version: sp120.hexcomp: "),
        (lambda _: "[nothing]\n", "", "malformed: sp120.hexcomp: "),
        (lambda text: text, "leg_length_mm=401", "other_machine: sp120.hexcomp: "),
    ],
    ids=["truncated", "altered", "later_version", "something_else", "other_machine"],
)
def test_a_wrong_file_is_refused_by_name(
    made: Made, tmp_path: Path, change: Callable[[str], str], words: str, expected: str
) -> None:
    wrong = change(made.compensation.read_text())
    status, printed = load(made, tmp_path / "first", f"compensation=sp120.hexcomp {words}", wrong)
    assert status != 0
    assert f"hexdbb_kins: compensation refused: {expected}" in printed
    assert "hexdbb-kins.enable" not in printed

    allowed = f"compensation=sp120.hexcomp without_compensation=1 {words}"
    status, printed = load(made, tmp_path / "again", allowed, wrong)
    assert status == 0
    assert f"hexdbb_kins: compensation refused: {expected}" in printed
    assert value(printed, "loaded") == "FALSE"


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("", "no compensation named (expected compensation=FILE.hexcomp or without_compensation=1)"),
        ("compensation=none.hexcomp", "compensation refused: cannot_read: none.hexcomp: "),
        ("compensation=sp120.hexcomp leg_length_mm=long", "leg_length_mm=long (expected a finite number)"),
        ("without_compensation=1 leg_length_mm=-4", "bad_argument: no machine of these dimensions can be assembled"),
    ],
    ids=["none_named", "no_such_file", "no_number", "no_machine"],
)
def test_a_wrong_parameter_is_refused(made: Made, tmp_path: Path, words: str, expected: str) -> None:
    status, printed = load(made, tmp_path / "work", words)
    assert status != 0
    assert f"hexdbb_kins: {expected}" in printed
