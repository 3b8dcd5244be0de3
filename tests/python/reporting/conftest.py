"""A machine with play in one slider, measured in few samples, with names that a page must not take for HTML."""

from __future__ import annotations

from dataclasses import replace
from datetime import date
from pathlib import Path

import pytest

from hexdbb.ledger import add_effect, fit_model
from hexdbb.machine import Tolerance
from hexdbb.model import Model, new_model
from hexdbb.plan import Conditions
from hexdbb.record import Record, conditions_metadata
from hexdbb.reporting import Report, make_report, write_page
from hexdbb.rig.mechanisms import MECHANISMS
from hexdbb.rig.truth import random_truth
from hexdbb.samples import Samples
from hexdbb_truth.plans import discovery_plan
from hexdbb_truth.simulate import Pace, simulate

HOSTILE = '<img src=x onerror="document.title=1">&\'"</script>'


@pytest.fixture(scope="session")
def record() -> Record:
    play = MECHANISMS["backlash"].model_validate({"kind": "backlash", "slider": 4, "width_um": 15.0})
    plan = discovery_plan()
    few = plan.model_copy(update={"laps": 1, "circles": plan.circles[:4]})
    truth = random_truth(11).model_copy(update={"mechanism": (play,)})
    made = simulate(truth, few, pace=Pace(rate_hz=3.0, instants_per_sample=4, travel_s=1.0))
    gauge = made.gauge.model_copy(update={"serial_number": HOSTILE, "calibrated": date(2026, 3, 1)})
    machine = made.machine.model_copy(update={"name": HOSTILE, "tolerance": Tolerance(radial_deviation_um=20.0)})
    stated = Conditions(operator=HOSTILE, notes=HOSTILE)
    metadata = {"started": HOSTILE, "plan": "standard", **conditions_metadata(stated)}
    return replace(made, gauge=gauge, machine=machine, metadata=metadata, path=Path("today<b>.parquet"))


@pytest.fixture(scope="session")
def without(record: Record) -> Model:
    return fit_model(Samples.of([record]), new_model(record.machine)).model


@pytest.fixture(scope="session")
def model(record: Record, without: Model) -> Model:
    return add_effect(Samples.of([record]), without, "backlash:4").model


@pytest.fixture(scope="session")
def report(record: Record, model: Model) -> Report:
    return make_report(Samples.of([record]), model)


@pytest.fixture(scope="session")
def page_file(report: Report, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("report") / "report.html"
    write_page(report, path)
    return path
