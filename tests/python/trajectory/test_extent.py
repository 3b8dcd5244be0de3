"""Machine time, rows and disk space of a plan are known before they are spent: what is too much is refused at once."""

from __future__ import annotations

from pathlib import Path

import pytest

from hexdbb.capture.request import Request, prepare
from hexdbb.errors import InputError
from hexdbb.machine import Limits, MachineFile
from hexdbb.plan import Plan, load_plan
from hexdbb.trajectory import ROWS_MAX, plan_programme, time_law
from hexdbb.trajectory.extent import estimated_extent

CYCLE_S = 0.004


def plan_with(**changed: object) -> Plan:
    return load_plan("thesis").model_copy(update=changed)


def machine_with(**limits: float) -> MachineFile:
    machine = load_plan("thesis").machine_file()
    changed = machine.can_setup.model_copy(update={"limits": Limits(**limits)})
    return machine.model_copy(update={"can": changed})


def refused(plan: Plan, machine: MachineFile, monkeypatch: pytest.MonkeyPatch) -> str:
    """Return the error of a plan that is refused before a single row of it is computed."""

    def none(*arguments: object) -> None:
        raise AssertionError("rows were computed")

    monkeypatch.setattr(time_law.TimeLaw, "u_mm", none)
    with pytest.raises(InputError) as caught:
        prepare(Request(plan, machine, "my.toml", CYCLE_S, Path("never.parquet")))
    message = str(caught.value)
    assert "\n" not in message
    assert message.startswith("my.toml: ")
    return message


@pytest.mark.parametrize("laps", [3000, 10**6, 10**9])
def test_too_many_laps_are_refused_before_a_row_is_computed(laps: int, monkeypatch: pytest.MonkeyPatch) -> None:
    message = refused(plan_with(laps=laps), machine_with(), monkeypatch)
    assert message.startswith(f"my.toml: circle 0, 753.98 mm/min, {laps} laps: the plan takes ")
    assert "(expected at most 4.44 h of machine time, 4,000,000 rows, 264.0 MB of targets" in message


@pytest.mark.parametrize("feed", [5e-324, 1e-9, 1e-3, 0.1])
def test_feeds_that_take_for_ever_are_refused_before_a_row_is_computed(
    feed: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert "the plan takes" in refused(plan_with(feeds_mm_min=(753.98, feed)), machine_with(), monkeypatch)


@pytest.mark.parametrize("name", ["jerk_mm_s3", "acceleration_mm_s2"])
@pytest.mark.parametrize("value", [5e-324, 1e-12, 1e-9])
def test_limits_that_take_for_ever_are_refused_before_a_row_is_computed(
    name: str, value: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert "the plan takes" in refused(plan_with(), machine_with(**{name: value}), monkeypatch)


@pytest.mark.parametrize(
    "limits",
    [
        {"velocity_mm_s": 5e-324},
        {"velocity_mm_s": 1e-9},
        {"velocity_mm_s": 1e300, "acceleration_mm_s2": 1e300, "jerk_mm_s3": 1e300},
    ],
)
def test_limits_without_a_time_law_are_refused_with_the_place(limits: dict[str, float]) -> None:
    with pytest.raises(InputError, match=r"^my\.toml: circle 0, 753\.98 mm/min") as caught:
        plan_programme(plan_with(), machine_with(**limits), CYCLE_S, "my.toml")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("feed", [1e9, 1e300])
def test_a_feed_beyond_all_limits_is_refused_with_the_place(feed: float) -> None:
    with pytest.raises(InputError, match=r"^my\.toml: circle 0, 1e\+\d+ mm/min, "):
        plan_programme(plan_with(feeds_mm_min=(feed,)), machine_with(), CYCLE_S, "my.toml")


def test_laps_beyond_the_numbers_of_a_record_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "my.toml"
    shipped = load_plan("thesis").path
    assert shipped is not None
    path.write_text(shipped.read_text().replace("\nlaps = 1", f"\nlaps = {10**400}"))
    with pytest.raises(InputError, match=r"my\.toml: laps: .*expected a number <= 2147483647"):
        load_plan(path)


@pytest.mark.parametrize("name", ["thesis", "standard"])
def test_the_estimate_is_that_of_the_table(name: str) -> None:
    plan = load_plan(name)
    machine = plan.machine_file()
    programme = plan_programme(plan, machine, CYCLE_S, name)
    estimate = estimated_extent(plan.runs(), plan.overshoot_deg, machine.can_setup.limits, CYCLE_S)
    assert 0.9 * len(programme) < estimate.rows < 1.05 * len(programme)
    assert programme.extent.rows == pytest.approx(len(programme))
    assert programme.extent.rows < ROWS_MAX / 5
