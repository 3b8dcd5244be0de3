"""Proposed plans: better than `standard`, valid, drivable, the same every time; and the plans of docs/planning.md."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from hexdbb.cli.plan import command
from hexdbb.errors import InputError
from hexdbb.identifiability import Observability, observability, plan_sensitivity
from hexdbb.machine import shipped
from hexdbb.model import new_model
from hexdbb.plan import Plan, load_plan
from hexdbb.planning import Grid, PlanRequest, RequiredClearances, circle_clearances, planned_unknowns, propose
from hexdbb.trajectory import plan_programme

ROOT = Path(__file__).parents[3]
PAGE = ROOT / "docs" / "planning.md"
BEST = {5: ROOT / "docs" / "plans" / "best-5.toml", 7: ROOT / "docs" / "plans" / "best-7.toml"}
RATE_HZ = 250.0


def seen(plan: Plan) -> Observability:
    return observability(plan_sensitivity(plan, new_model(plan.machine_file()), RATE_HZ))


def proposed(path: Path, *options: str) -> Plan:
    arguments = ["propose", "--grid", "coarse", "-o", str(path), "--overwrite", *options]
    done = CliRunner().invoke(command, arguments, catch_exceptions=False)
    assert done.exit_code == 0
    return load_plan(path)


@pytest.mark.parametrize("count", [5, 7])
def test_best_plans_of_the_page_beat_standard(count: int) -> None:
    standard, best = seen(load_plan("standard")), seen(load_plan(BEST[count]))
    assert (standard.rank, round(standard.condition)) == (21, 506)
    assert best.rank == 21
    assert best.condition < standard.condition / 3
    assert best.o1 > 2 * standard.o1
    assert best.o3 > 4 * standard.o3
    assert best.o4 > 15 * standard.o4
    assert len(load_plan(BEST[count]).circles) == count


@pytest.mark.parametrize("count", [5, 7])
def test_best_plans_of_the_page_can_be_driven_with_the_required_clearances(count: int) -> None:
    plan = load_plan(BEST[count])
    machine = plan.machine_file()
    plan_programme(plan, machine, 1.0 / RATE_HZ, "best")
    for circle in plan.circles:
        found = circle_clearances(machine, circle, plan.mount_of(circle).cup_mm)
        assert found is not None
        assert RequiredClearances().met_by(found)


def test_the_table_of_the_page_is_what_its_command_prints() -> None:
    names = ["standard", "docs/plans/best-5.toml", "docs/plans/best-7.toml"]
    page = PAGE.read_text(encoding="utf-8")
    assert f"hexdbb plan compare {' '.join(names)}" in page
    paths = [names[0], *(str(ROOT / name) for name in names[1:])]
    done = CliRunner().invoke(command, ["compare", *paths, "--json"], catch_exceptions=False)
    for name, found in zip(names, json.loads(done.stdout).values(), strict=True):
        row = next(line.split() for line in page.splitlines() if line.split()[:1] == [name])
        indices = [f"{found['observability'][each]:.2e}" for each in ("o1", "o3", "o4")]
        assert row[3:8] == [str(found["rank"]), f"{found['condition']:.0f}", *indices]


@pytest.mark.parametrize("suffix", [".png", ".svg"])
def test_plans_can_be_drawn_in_one_picture(tmp_path: Path, suffix: str) -> None:
    drawn = tmp_path / f"plans{suffix}"
    CliRunner().invoke(command, ["compare", "thesis", "standard", "--plot", str(drawn)], catch_exceptions=False)
    text = drawn.read_bytes()
    assert text.startswith(b"\x89PNG" if suffix == ".png" else b"<?xml")
    done = CliRunner().invoke(command, ["compare", "thesis", "--plot", str(tmp_path / "plans.pdf")])
    assert isinstance(done.exception, InputError)
    assert "expected .png or .svg" in str(done.exception)


def test_tilted_planes_are_chosen_because_they_determine_the_cups_height(tmp_path: Path) -> None:
    plan = proposed(tmp_path / "plan.toml", "--circles", "5")
    assert any(any(circle.plane_rpy_deg) for circle in plan.circles)
    assert "cup_position:1 z changes no reading" in seen(load_plan("standard")).unidentifiable
    assert not any("cup_position" in each for each in seen(plan).unidentifiable)


def test_a_coarse_search_finds_better_circles_than_standard_and_the_same_each_time(tmp_path: Path) -> None:
    first = proposed(tmp_path / "first.toml", "--circles", "5", "--criterion", "minmax")
    second = proposed(tmp_path / "second.toml", "--circles", "5", "--criterion", "minmax")
    assert first == second
    found, standard = seen(first), seen(load_plan("standard"))
    assert (found.rank, len(first.circles), len(first.mounts)) == (21, 5, 1)
    assert found.condition < standard.condition / 2
    assert found.o3 > standard.o3


def test_circles_about_two_cups_stand_cup_by_cup() -> None:
    """Two circles are within reach about each of two cups, and four are wanted."""
    like = load_plan("standard")
    machine = like.machine_file()
    grid = Grid(
        heights=(0.0,), places=(0.0, 0.2), place_azimuths=(30.0,), tilts=(0.0,), yaws=(-15.0, 15.0), plane_tilts=(0.0,)
    )
    unknowns = planned_unknowns(new_model(machine), None, 0.5e-3, RATE_HZ)
    steps: list[str] = []
    plan = propose(PlanRequest(like, machine, unknowns, circles=4, most_mounts=2, grid=grid), steps.append)
    assert sorted(mount.cup_mm for mount in plan.mounts) == [(0.0, 0.0, 340.0), (17.32, 10.0, 340.0)]
    assert [circle.mount for circle in plan.circles] == [0, 0, 1, 1]
    assert [circle.id for circle in plan.circles] == [0, 1, 2, 3]
    assert steps
    plan_programme(plan, machine, 1.0 / RATE_HZ, "two cups")


def test_each_criterion_wins_by_its_own_measure(tmp_path: Path) -> None:
    volume, smallest = (
        seen(proposed(tmp_path / f"{name}.toml", "--circles", "6", "--criterion", name)) for name in ("D", "minmax")
    )
    assert volume.o1 > smallest.o1
    assert smallest.o3 > volume.o3


def test_a_plan_aimed_at_an_effect_detects_a_smaller_one(tmp_path: Path) -> None:
    """The bar's length: a plan for it detects a smaller error of it than one for the machine as a whole."""
    sizes = {}
    for name, options in (("aimed", ["--aim", "bar_length"]), ("whole", [])):
        proposed(tmp_path / f"{name}.toml", "--circles", "4", *options)
        done = CliRunner().invoke(command, ["check", str(tmp_path / f"{name}.toml"), "--json"], catch_exceptions=False)
        sizes[name] = json.loads(done.stdout)["detectable"]["bar_length"]["size"]
    assert sizes["aimed"] < sizes["whole"]


def test_the_file_names_its_machine_from_where_it_stands(tmp_path: Path) -> None:
    machine = tmp_path / "machines" / "mine.toml"
    machine.parent.mkdir()
    machine.write_text(shipped("sp120.toml").read_text().replace("400.0 ", "402.0 "))
    (tmp_path / "plans").mkdir()
    output = tmp_path / "plans" / "plan.toml"
    plan = proposed(output, "--circles", "2", "--machine", str(machine))
    assert plan.machine == "../machines/mine.toml"
    assert plan.machine_file().legs.length_mm == 402.0


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--circles", "0"], r"^circles 0: no circle to choose \(expected 1 or more\)$"),
        (["--circles", "3", "--mounts", "0"], r"^mounts 0: no position for the cup \(expected 1 or more\)$"),
        (["--circles", "3", "--criterion", "E"], r"^criterion E: not known \(expected one of D, minmax\)$"),
        (["--circles", "3", "--aim", "rust"], r'^no effect has the name "rust" \(known: leg_length, '),
        (["--circles", "3", "--like", "none"], r"^none: no such file"),
        (["--circles", "999"], r"^the proposed plan: .* of machine time, .* \(expected at most .* of machine time"),
    ],
)
def test_what_cannot_be_proposed_is_one_line_and_writes_nothing(
    tmp_path: Path, options: list[str], message: str
) -> None:
    output = tmp_path / "plan.toml"
    arguments = ["propose", "--grid", "coarse", "-o", str(output), *options]
    done = CliRunner().invoke(command, arguments)
    assert isinstance(done.exception, InputError)
    assert done.exception.exit_status == 2
    with pytest.raises(InputError, match=message):
        raise done.exception
    assert "\n" not in str(done.exception)
    assert not list(tmp_path.iterdir())


def test_a_machine_that_reaches_no_candidate_is_refused(tmp_path: Path) -> None:
    like = tmp_path / "like.toml"
    text = shipped("plans", "standard.toml").read_text().replace("340.0", "700.0")
    like.write_text(text)
    done = CliRunner().invoke(
        command, ["propose", "--circles", "2", "--like", str(like), "-o", str(tmp_path / "p.toml")]
    )
    assert isinstance(done.exception, InputError)
    assert str(done.exception).startswith(f"{like}: no circle of the grid is within reach")


def test_an_existing_file_is_left_alone(tmp_path: Path) -> None:
    output = tmp_path / "plan.toml"
    output.write_text("mine")
    done = CliRunner().invoke(command, ["propose", "--circles", "2", "-o", str(output)])
    assert isinstance(done.exception, InputError)
    assert output.read_text() == "mine"


def test_a_plan_that_could_not_be_computed_is_refused_before_the_search() -> None:
    like = load_plan("standard").model_copy(update={"laps": 10**6})
    machine = like.machine_file()
    unknowns = planned_unknowns(new_model(machine), None, 0.5e-3, RATE_HZ)
    steps: list[str] = []
    with pytest.raises(InputError, match=r"the proposed plan: circle 0, .* 1000000 laps: the plan takes"):
        propose(PlanRequest(like, machine, unknowns, circles=4, most_mounts=1), steps.append)
    assert steps == []
