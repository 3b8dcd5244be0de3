"""Studies on real worker processes: the same whatever their number, continued, refused where they do not fit."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hexdbb.cluster import Cluster
from hexdbb.errors import InputError, RunError
from hexdbb.plan import load_plan, save_plan
from hexdbb.planning import circle_clearances
from hexdbb.studies.file import changed, load_study
from hexdbb.studies.kinds import KINDS, study_named
from hexdbb.studies.page import study_page
from hexdbb.studies.running import Ran, run_study
from hexdbb.studies.setting import Setting, setting_of

SHORT = {"rate_hz": 10.0, "feeds_mm_min": [3000.0]}
"""1,750 readings a case."""
SMALL: dict[str, dict[str, Any]] = {
    "power": {
        "cases": 5,
        "power": {"effects": ["backlash", "ball_eccentricity"], "times_noise": [4.0, 5.0], "learned": False},
    },
    "coverage": {"cases": 4},
    "verdicts": {"cases": 2, "verdicts": {"own_plans": False}, "seed": 1},
    "plan": {"cases": 2, "plan_search": {"circles": [3, 4]}},
    "tolerance": {
        "cases": 6,
        "tolerance": {
            "noise_um": [0.5],
            "repeatability_um": [3.0],
            "scale_error_percent": [1.0],
            "bar_length_um": [1.0],
            "cup_um": [100.0, 5000.0],
        },
    },
}


def setting(name: str, **more: Any) -> Setting:
    return setting_of(changed(load_study("standard"), {**SHORT, **SMALL[name], **more}, "test"))


@pytest.fixture(scope="module")
def ran(two_workers: Cluster, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Ran]:
    place = tmp_path_factory.mktemp("studies")
    return {name: run_study(study_named(name), setting(name), str(place / name), two_workers) for name in KINDS}


def without_time(run: Ran) -> list[dict[str, Any]]:
    """Rows without the time that they took."""
    timed = {"seconds", "line"}
    return [{key: value for key, value in row.items() if key not in timed} for row in run.rows]


@pytest.mark.parametrize("name", KINDS)
def test_every_case_has_a_row_and_the_study_an_answer(ran: dict[str, Ran], name: str) -> None:
    run, own = ran[name], setting(name)
    assert not run.failed
    assert [row["case"] for row in run.rows] == list(range(own.file.cases))
    assert run.result.answer
    for sheet in run.result.sheets:
        assert sheet.rows
        assert {len(row) for row in sheet.rows} == {len(sheet.head)}
    page = study_page(study_named(name).question, own, run.result, "images/x.png", "hexdbb study")
    assert "nan" not in page
    assert run.result.draw().axes


@pytest.mark.parametrize("name", ["power", "tolerance"])
def test_one_worker_and_two_give_the_same(ran: dict[str, Ran], one_worker: Cluster, name: str, tmp_path: Path) -> None:
    alone = run_study(study_named(name), setting(name), str(tmp_path / name), one_worker)
    assert alone.rows == ran[name].rows
    assert alone.result.sheets == ran[name].result.sheets
    assert alone.result.answer == ran[name].result.answer


def test_a_study_is_continued_and_made_larger(two_workers: Cluster, tmp_path: Path) -> None:
    study, url = study_named("coverage"), str(tmp_path / "cases")
    first = run_study(study, setting("coverage", cases=2), url, two_workers)
    more = run_study(study, setting("coverage", cases=3), url, two_workers)
    assert (more.summary.before, more.summary.done) == (2, 1)
    assert more.rows[:2] == first.rows
    again = run_study(study, setting("coverage", cases=2), url, two_workers)
    assert again.rows == first.rows, "a smaller study of the same folder is that of its own cases"


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"seed": 9}, r"whose seed is 1 \(expected 9, as in this one"),
        ({"gauge": {"noise_um": 0.7}}, r"whose gauge\.noise_um is 0\.5 \(expected 0\.7,"),
        ({"laps": 2}, r"whose plan\.laps is 1 \(expected 2,"),
        ({"machine_errors": {"cup_um": 50.0}}, r"whose machine_errors\.cup_um is 100 \(expected 50,"),
    ],
)
def test_a_folder_of_another_study_is_refused(
    changes: dict[str, Any], said: str, two_workers: Cluster, tmp_path: Path
) -> None:
    study, url = study_named("coverage"), str(tmp_path / "cases")
    run_study(study, setting("coverage", cases=1), url, two_workers)
    with pytest.raises(InputError, match=rf"^{url}: results of another study, {said}"):
        run_study(study, setting("coverage", cases=1, **changes), url, two_workers)
    with pytest.raises(InputError, match="results of another study, whose"):
        run_study(study_named("tolerance"), setting("tolerance", cases=1), url, two_workers)


def test_large_faults_are_named_and_absorbed_ones_said_to_be(ran: dict[str, Ran]) -> None:
    rows = ran["power"].rows
    by_effect = {
        effect: [row for row in rows if row["effect"] == effect] for effect in ("backlash", "ball_eccentricity")
    }
    assert [row["outcome"] for row in by_effect["backlash"]] == ["right", "right"]
    assert all(row["size"] > 5.0 and row["unit"] == "um" for row in by_effect["backlash"])
    assert [row["outcome"] for row in by_effect["ball_eccentricity"]] == ["absorbed", "absorbed"]
    assert [row["outcome"] for row in rows if row["effect"] is None] == ["right"]
    assert any("geometry and set-up absorb it" in sentence for sentence in ran["power"].result.answer)


def test_tolerances_are_told_from_what_they_do(ran: dict[str, Ran]) -> None:
    by_factor = {(row["factor"], row["level"]): row for row in ran["tolerance"].rows}
    usual = by_factor["noise_um", 0.5]["after_um"]
    assert by_factor["repeatability_um", 3.0]["after_um"] > 5.0 * usual
    assert by_factor["bar_length_um", 1.0]["after_um"] < 2.0 * usual
    assert by_factor["cup_um", 5000.0]["after_um"] is None
    assert "expected within 1000 µm" in by_factor["cup_um", 5000.0]["refused"]
    assert any("not even at 3 µm" in sentence for sentence in ran["tolerance"].result.answer)


def test_plans_found_can_be_driven_and_more_circles_are_more_certain(ran: dict[str, Ran], tmp_path: Path) -> None:
    three, four = ran["plan"].rows
    assert three["place_um"] > four["place_um"] > 0.0
    plan, machine = ran["plan"].result.plans["4-circles"], setting("plan").machine
    assert len(plan.circles) == 4
    save_plan(plan.model_copy(update={"machine": "sp120"}), tmp_path / "found.toml", "found")
    found = load_plan(str(tmp_path / "found.toml"))
    for circle in found.circles:
        assert circle_clearances(machine, circle, found.mount_of(circle).cup_mm) is not None


def test_cases_of_verdicts_are_the_series_of_the_half(ran: dict[str, Ran]) -> None:
    names = [case["name"] for case in study_named("verdicts").cases(setting("verdicts", cases=300))]
    assert [row["name"] for row in ran["verdicts"].rows] == names[:2]
    assert all("-judge-" in name for name in names)
    assert {name.startswith("none") for name in names} == {True, False}
    assert len({"+" in name for name in names}) == 2


def test_verdicts_judge_cases_asked_for_by_name() -> None:
    names = ["platform_corner_swings-d0-x100-judge-s0", "none-judge-s3", "chords_for_arc-d0-x3-judge-s0"]
    study, asked = study_named("verdicts"), setting("verdicts", verdicts={"names": names})
    assert asked.file.cases == 2
    cases = study.cases(asked)
    assert [case["name"] for case in cases] == names[:2]
    assert asked.fingerprint("verdicts") == setting("verdicts", verdicts={}).fingerprint("verdicts")
    line = json.loads(study.row(asked, cases[0])["line"])
    assert line["case"] == names[0]
    assert "100 x noise is beyond 300" in line["unreachable"]
    with pytest.raises(InputError, match=r'^case "gremlin-d0-x3-judge-s0": kind "gremlin"'):
        study.cases(setting("verdicts", verdicts={"names": ["gremlin-d0-x3-judge-s0"]}))


def test_a_run_of_which_every_case_fails_says_why(two_workers: Cluster, tmp_path: Path) -> None:
    far = setting("coverage", cases=2, machine_errors={"cup_um": 9000.0})
    with pytest.raises(RunError, match="every case failed: sweep 0: reading of"):
        run_study(study_named("coverage"), far, str(tmp_path / "cases"), two_workers)


def test_machines_are_drawn_with_the_spread_and_the_gauge_asked_for() -> None:
    own = setting("coverage", machine_errors={"length_um": 5.0}, gauge={"noise_um": 2.0})
    usual = setting("coverage")
    one, other = own.machine_of(7), usual.machine_of(7)
    np.testing.assert_allclose(one.geometry.leg_length_um, np.array(other.geometry.leg_length_um) / 10.0, atol=1e-3)
    assert one.setup == other.setup
    assert (one.gauge.noise_um, own.plan.gauge.noise_um) == (2.0, 2.0)
    assert own.number(3) != changed_seed(own).number(3)


def changed_seed(own: Setting) -> Setting:
    return setting_of(changed(own.file, {"seed": own.file.seed + 1}, "test"))
