"""The session: every action gives what the function behind it gives, and its script gives the same again."""

from __future__ import annotations

import runpy
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hexdbb as hx
from hexdbb.discovery.result import NextTest
from hexdbb.workbench import Session
from hexdbb.workbench.outputs import write_compensation, write_next_plan, write_report


@pytest.fixture
def session(folder: Path) -> Session:
    return Session([Path("today.parquet")], Path("model.toml"))


def run_script(text: str, folder: Path) -> dict[str, Any]:
    (folder / "copied.py").write_text(text, encoding="utf-8")
    return runpy.run_path(str(folder / "copied.py"))


def test_story_and_the_script_of_it_give_the_same_numbers(session: Session, folder: Path) -> None:
    before_um = session.prediction.rms_um
    session.select(session.selections[3])
    found = session.ask()
    assert found.best is not None
    assert found.best.choice == "backlash:4"
    session.preview("backlash:4")
    previewed_um = session.prediction.rms_um
    assert previewed_um < 0.5 * before_um
    assert hx.load_model("model.toml").term("backlash") is None  # nothing is kept
    session.add("backlash:4")
    assert session.prediction.rms_um == pytest.approx(previewed_um, rel=1e-3)
    session.switch("leg_length", on=False)
    session.set_value("backlash:4 play", 5.0)
    shown_um, model = session.prediction.rms_um, session.model
    again = run_script(session.script.text, folder)
    assert hx.predict(again["samples"], again["shown"]).rms_um == shown_um
    np.testing.assert_array_equal(again["model"].values, model.values)
    assert [step.what for step in again["model"].ledger] == ["diagnose", "add"]
    assert again["found"].sentence == found.sentence


def test_undo_returns_to_the_model_that_was_opened(session: Session, folder: Path) -> None:
    opened = session.model
    session.add("backlash:4")
    session.undo()
    np.testing.assert_array_equal(session.model.values, opened.values)
    again = run_script(session.script.text, folder)
    np.testing.assert_array_equal(again["model"].values, opened.values)
    assert len(hx.load_model("model.toml").ledger) == 1


def test_without_a_model_a_new_one_is_fitted_and_written_where_it_is_saved(folder: Path) -> None:
    session = Session([Path("today.parquet")])
    assert not session.is_fitted
    nominal_um = session.prediction.rms_um
    session.fit()
    assert session.prediction.rms_um < 0.2 * nominal_um
    assert session.sufficiency.matters
    with pytest.raises(hx.InputError, match=r"model\.toml: exists already"):
        session.save_as(Path("model.toml"))
    session.save_as(Path("mine.toml"))
    session.undo()
    assert not hx.load_model("mine.toml").ledger
    Path("mine.toml").unlink()
    assert not run_script(session.script.text, folder)["model"].ledger


def test_an_effect_switched_off_is_as_if_it_were_not_there(session: Session) -> None:
    session.switch("leg_length", on=False)
    without = session.model.without_effect(hx.model.Choice("leg_length"))
    np.testing.assert_allclose(
        session.prediction.reading_mm, hx.predict(session.samples, without).reading_mm, rtol=0.0, atol=1e-12
    )
    session.switch("leg_length", on=True)
    assert session.tried.is_nothing
    assert session.prediction.rms_um == hx.predict(session.samples, session.model).rms_um


def test_values_dragged_leave_one_step_in_the_script(session: Session) -> None:
    before = len(session.script.steps)
    for value in (1.0, 2.0, 3.0):
        session.set_value("leg_length:1 longer", value)
    assert len(session.script.steps) == before + 1
    index = [each.label for each in session.shown.parameters()].index("leg_length:1 longer")
    assert session.shown.values[index] == pytest.approx(0.003)
    session.back_to_fit()
    assert session.tried.is_nothing


@pytest.mark.parametrize(
    ("action", "message"),
    [
        (lambda session: session.switch("nonsense", on=False), "nonsense: not in model.toml"),
        (lambda session: session.set_value("leg_length:1 shorter", 1.0), "no such value in model.toml"),
        (lambda session: session.set_value("leg_length:1 longer", float("nan")), "nan \\(expected a number of um\\)"),
        (lambda session: session.add("nonsense:4"), "nonsense"),
        (lambda session: session.preview("leg_length:1"), "model.toml has it already"),
    ],
)
def test_bad_input_is_refused_and_changes_nothing(session: Session, action: Any, message: str) -> None:
    steps, model = list(session.script.steps), session.model
    with pytest.raises(hx.InputError, match=message):
        action(session)
    assert (session.script.steps, session.model, session.changes.busy) == (steps, model, "")
    assert session.tried.is_nothing


def test_a_model_changed_on_disk_is_not_overwritten(session: Session) -> None:
    other = Session([Path("today.parquet")], Path("model.toml"))
    other.add("backlash:4")
    written = Path("model.toml").read_bytes()
    with pytest.raises(hx.InputError, match=r"model\.toml: was changed since it was opened"):
        session.fit()
    assert Path("model.toml").read_bytes() == written
    assert len(session.model.ledger) == 1
    session.reload()
    assert len(session.model.ledger) == 2


def test_a_model_removed_on_disk_is_said(session: Session) -> None:
    Path("model.toml").unlink()
    with pytest.raises(hx.InputError, match=r"model\.toml: was removed"):
        session.undo()


def test_a_record_removed_meanwhile_is_named_and_its_readings_stay(session: Session) -> None:
    assert session.missing_records() == []
    shutil.move("today.parquet", "gone.parquet")
    assert session.missing_records() == ["today.parquet"]
    session.preview("backlash:4")
    assert session.prediction.rms_um < 1.0


def test_a_second_action_is_refused_while_one_runs(session: Session) -> None:
    refused = []

    def progress(_: str) -> None:
        with pytest.raises(hx.InputError, match="not now, looking for what is missing"):
            session.undo()
        session.switch("leg_length", on=False)  # what is shown is not held up
        refused.append(session.prediction.rms_um)

    session.ask(progress)
    assert refused
    assert session.changes.busy == ""


def test_what_follows_is_written_and_in_the_script(session: Session, monkeypatch: pytest.MonkeyPatch) -> None:
    session.add("backlash:4")
    left_out = write_compensation(session, Path("mine.hexcomp"))
    assert {name for name, _ in left_out} >= {"cup_position", "ball_offset"}
    proposed = hx.load_plan("thesis")  # what is proposed is tested with the planner: here it takes too long
    monkeypatch.setattr("hexdbb.api.propose_plan", lambda circles, **_: proposed)
    assert write_next_plan(session, Path("next.toml")) == "determines most of the machine's errors alone"
    assert hx.load_plan("next.toml").circles == proposed.circles
    with pytest.raises(hx.InputError, match=r"next\.toml: exists already"):
        write_next_plan(session, Path("next.toml"))
    assert session.script.lines[-1] == "hx.save_plan(plan, 'next.toml', machine=records[0].machine)"
    assert "hx.compensate(model, 'mine.hexcomp')" in session.script.lines
    assert write_report(session, Path("report.html"))
    assert "backlash" in Path("report.html").read_text(encoding="utf-8")


def test_the_next_circle_tells_apart_what_was_found(session: Session) -> None:
    circle = session.records[0].circles[2].model_copy(update={"platform_rpy_deg": (3.0, 0.0, 0.0)})
    test = NextTest(circle, 1500.0, 9.0, ("backlash:4", "reversal_spike:4"))
    session.found = replace(session.ask(), next_test=test)
    assert write_next_plan(session, Path("next.toml")) == "tells backlash:4 from reversal_spike:4"
    plan = hx.load_plan("next.toml")
    assert (plan.circles, plan.feeds_mm_min) == ((circle,), (1500.0,))
    assert plan.gauge == session.records[0].gauge
    assert plan.machine_file() == session.samples.machine
    with pytest.raises(hx.InputError, match="no circle tells apart"):
        hx.plan_next_test(replace(session.found, next_test=None))


def test_a_plan_names_a_machine_of_its_own_beside_it(session: Session) -> None:
    machine = session.samples.machine.model_copy(update={"name": "mine"})
    hx.save_plan(hx.load_plan("thesis"), "own.toml", "A comment.", machine)
    assert hx.load_plan("own.toml").machine_file().name == "mine"
    assert Path("own.toml").read_text(encoding="utf-8").startswith("# A comment.\n")
