"""`hexdbb machine new` and `hexdbb machine check` as a user calls them."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from hexdbb.cli.machine import command
from hexdbb.cli.machine_questions import QUESTIONS
from hexdbb.cli.plan import command as plan_command
from hexdbb.cli.prompts import prompted
from hexdbb.errors import InputError, InterruptError, RunError
from hexdbb.machine import load_machine, shipped_machine
from hexdbb.plan import load_plan

UNLIKE = Path(__file__).parents[2] / "data" / "machines" / "unlike.toml"


def run(*arguments: str, answers: str | None = None) -> Result:
    return CliRunner().invoke(command, list(arguments), input=answers, catch_exceptions=False)


def test_defaults_are_the_shipped_machine(tmp_path: Path) -> None:
    done = run("new", "-o", str(tmp_path / "m.toml"), "--defaults", "--circles", "0")
    assert done.exit_code == 0
    written, shipped = load_machine(tmp_path / "m.toml"), shipped_machine()
    for part in ("base", "platform", "legs", "sliders", "can"):
        assert getattr(written, part) == getattr(shipped, part)
    assert (tmp_path / "m.png").stat().st_size > 10_000
    assert "nothing is near a limit or a singular pose" in done.stdout


def test_options_make_a_machine_and_a_plan_that_pass_the_checks(tmp_path: Path) -> None:
    machine = load_machine(UNLIKE)
    options = [
        *("--name", "mine", "--inradius", "260", "--guideway-angles", "0,100,230", "--circumradius", "115"),
        *("--joint-angles", "0,108,236", "--joint-height", "22", "--mass", "14"),
        *("--leg-length", "398,403,407,391,400,412", "--gap", "58", "--nodes", "11,12,13,14,15,16"),
        *("--travel", "40,450; 430,860; 25,445; 445,880; 30,440; 440,870"),
        *("--workspace", "0,0,255,100,0,10", "--circles", "3", "--grid", "coarse", "--plot", str(tmp_path / "p.svg")),
    ]
    done = run("new", "-o", str(tmp_path / "m.toml"), "--defaults", *options)
    assert done.exit_code == 0
    written = load_machine(tmp_path / "m.toml")
    for part in ("base", "platform", "legs", "sliders", "workspace"):
        assert getattr(written, part) == getattr(machine, part)
    assert written.can_setup.drive_nodes == (11, 12, 13, 14, 15, 16)
    plan = load_plan(tmp_path / "m-plan.toml")
    assert (plan.machine, len(plan.circles), plan.gauge.bar_length_mm) == ("m.toml", 3, 100.0)
    assert "expected at most 100 for an identification to be trusted" in done.stderr
    checked = CliRunner().invoke(
        plan_command, ["check", str(tmp_path / "m-plan.toml"), "--json"], catch_exceptions=False
    )
    assert json.loads(checked.stdout)["reachable"]
    assert run("check", str(tmp_path / "m.toml")).exit_code == 0


def test_questions_have_defaults_and_wrong_answers_are_asked_again(tmp_path: Path) -> None:
    answers = ["bench", *[""] * (len(QUESTIONS) - 1)]
    at = [each.option for each in QUESTIONS].index("leg-length")
    answers[at : at + 1] = ["120", "390"]
    text = "\n".join([*answers, "0,0,280,500", "0,0,250,60,10,5", "0", ""])
    done = run("new", "-o", str(tmp_path / "m.toml"), answers=text)
    assert done.exit_code == 0
    assert "legs.length_mm: 120 (expected more than 130" in done.stderr
    assert "workspace.radius_mm: 500 (expected at most" in done.stderr
    machine = load_machine(tmp_path / "m.toml")
    assert (machine.name, machine.legs.length_mm) == ("bench", 390.0)
    assert machine.workspace is not None
    assert machine.workspace.radius_mm == 60.0


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--leg-length", "12a"), '--leg-length: "12a" (expected one number, or six with commas)'),
        (("--leg-length", "nan"), "m.toml: legs.length_mm: nan (expected a finite number)"),
        (("--travel", "846,20"), "m.toml: sliders.travel_mm: [846.0, 20.0] (expected the least coordinate before the"),
        (("--leg-length", "400,401"), '--leg-length: "400,401" (expected one number, or six with commas)'),
        (("--travel", "20,846;30,840"), "expected two numbers with a comma, or six pairs with semicolons"),
        (("--nodes", "1,2,3,3,5,6"), "m.toml: can.drive_nodes[3]: 3 (expected a node id not used by another drive)"),
        (("--workspace", "0,0,280,300"), "m.toml: workspace.radius_mm: 300 (expected at most "),
        (("--bar", "300"), "bar length 300 mm: no circle of it fits (expected at most the workspace's radius, 100 mm)"),
    ],
)
def test_bad_input_is_one_line_and_nothing_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, options: tuple[str, ...], message: str
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError) as error:
        run("new", "-o", "m.toml", "--defaults", *options)
    assert message in str(error.value)
    assert "\n" not in str(error.value)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("answers", "option"),
    [([], "name"), (["bench", "240"], "guideway-angles"), ([""] * len(QUESTIONS), "workspace")],
    ids=["none", "two", "those of the machine alone"],
)
def test_without_a_terminal_the_option_that_answers_is_named_and_nothing_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, answers: list[str], option: str
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match="the input has ended") as error:
        run("new", "-o", "m.toml", answers="".join(f"{each}\n" for each in answers))
    assert f"--{option} VALUE, or --defaults" in str(error.value)
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_at_a_question_interrupts(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object, **__: object) -> str:
        raise KeyboardInterrupt

    monkeypatch.setattr("click.termui.visible_prompt_func", interrupted)
    monkeypatch.setattr("hexdbb.cli.prompts.say", lambda text: None)
    with pytest.raises(InterruptError):
        prompted("name", "Name of the machine", default="bench")


def test_a_wrong_answer_is_asked_for_again_before_it_makes_defaults(tmp_path: Path) -> None:
    answers = ["", "-5", "280", "0,130", "0,130,230", *[""] * 4, "43", "430,431,429,433,428,434", *[""] * 10]
    done = run("new", "-o", str(tmp_path / "m.toml"), "--circles", "0", answers="\n".join([*answers, ""]))
    assert done.exit_code == 0
    for refused in (
        "base.inradius_mm: -5 (expected a number > 0)",
        '--guideway-angles: "0,130" (expected three numbers with commas)',
        "legs.length_mm: 43 (expected more than 146, the distance between guideway and joint circle",
    ):
        assert done.output.count(refused) == 1
    machine = load_machine(tmp_path / "m.toml")
    assert machine.base.guideway_angles_deg == (0.0, 130.0, 230.0)
    assert (machine.platform.circumradius_mm, machine.legs.lengths_mm[5]) == (134.0, 434.0)


def test_check_states_what_is_wrong_by_its_exit_status(tmp_path: Path) -> None:
    path = tmp_path / "m.toml"
    shutil.copy(UNLIKE, path)
    done = run("check", str(path), "--json")
    told = json.loads(done.stdout)
    assert (done.exit_code, told["findings"], told["reached"]) == (0, [], told["poses"])
    with pytest.raises(
        RunError, match=r"m\.toml: slider 3 to its end of travel at 25 mm: .* \(expected 5 mm or more\)"
    ):
        run("check", str(path), "--workspace", "0,0,239,100,0,12")
    with pytest.raises(InputError, match=r"workspace\.centre_mm: \[0\.0, 0\.0, 900\.0\] \(expected a place that"):
        run("check", str(path), "--workspace", "0,0,900,10")


def test_check_takes_the_shipped_machine_and_draws_it(tmp_path: Path) -> None:
    done = run("check", "sp120", "--plot", str(tmp_path / "sp120.png"))
    assert done.exit_code == 0
    assert "chosen because the file has none" in done.stdout
    assert (tmp_path / "sp120.png").is_file()
