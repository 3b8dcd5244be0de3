"""What the cases of a study have in common: machine, plan, gauge and spread, at hand wherever a case is computed."""

from __future__ import annotations

import hashlib
import json
import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from hexdbb.errors import InputError
from hexdbb.machine import MachineFile, machine_beside
from hexdbb.plan import Plan, load_plan, shipped_plans
from hexdbb.planning import circle_clearances
from hexdbb.rig.truth import GaugeTruth, TruthFile, random_truth
from hexdbb.studies.file import StudyFile
from hexdbb_truth.simulate import Pace

ASSUMED_NOISE_UM = 0.5
"""Noise of a gauge of which neither study nor plan states any: the order of common ball bars."""
CYCLE_HZ = 250.0
"""Instants per second that mechanisms with a memory (play, friction) go through: the cycle of the simulated rig."""
SEEDS_APART = 1_000_003
"""Distance between the machines of two seeds: a prime above any number of cases."""

CHOOSE_CASES = frozenset({"names"})
"""Keys of a study's own table that choose cases, which differ from each other by their names alone."""


@dataclass(frozen=True)
class Setting:
    """A study file with the files that it names.

    Attributes
    ----------
    file : StudyFile
    plan : Plan
        With the study's feeds and laps, on `machine`.
    machine : MachineFile
    gauge : GaugeTruth
        Of the true machines.
    """

    file: StudyFile
    plan: Plan
    machine: MachineFile
    gauge: GaugeTruth

    @property
    def pace(self) -> Pace:
        """How finely time is cut."""
        rate_hz = self.file.rate_hz
        return Pace(rate_hz=rate_hz, instants_per_sample=max(1, math.ceil(CYCLE_HZ / rate_hz)))

    @property
    def noise_mm(self) -> float:
        """Standard deviation of one reading as its specification states it, rounding included."""
        noise_mm = self.plan.gauge.stated_noise_mm
        assert noise_mm is not None  # `setting_of` states one
        return noise_mm

    def with_gauge(self, gauge: GaugeTruth) -> Setting:
        """Return the same with another gauge, whose specification, of which a diagnosis knows, states what it is."""
        stated = self.plan.gauge.model_copy(update={"noise_um": gauge.noise_um, "resolution_um": gauge.resolution_um})
        return replace(self, plan=self.plan.model_copy(update={"gauge": stated}), gauge=gauge)

    def number(self, case: int) -> int:
        """Return the number of a case's machine, which draws all there is of it."""
        return self.file.seed * SEEDS_APART + case

    def machine_of(self, number: int) -> TruthFile:
        """Return the true machine of a number: errors of geometry and set-up, and the gauge."""
        truth = random_truth(number, self.file.machine_errors)
        return truth.model_copy(update={"gauge": self.gauge})

    def content(self, study: str) -> dict[str, Any]:
        """Return all that the cases of one study depend on, but for which of them are run, as JSON."""
        keys = self.file.model_dump(mode="json", by_alias=True)
        tables = ("power", "coverage", "verdicts", "plan_search", "tolerance")
        left_out = {"cases", "plan", "machine", "feeds_mm_min", "laps", "gauge", *tables}
        own = "plan_search" if study == "plan" else study
        return {
            "study": study,
            **{key: value for key, value in keys.items() if key not in left_out},
            own: {key: value for key, value in keys[own].items() if key not in CHOOSE_CASES},
            "gauge": self.gauge.model_dump(mode="json"),
            "plan": self.plan.model_dump(mode="json", by_alias=True, exclude={"machine"}),
            "machine": self.machine.model_dump(mode="json", by_alias=True),
        }

    def fingerprint(self, study: str) -> str:
        """Return the hash of `content`: results of equal ones may lie in one dataset."""
        text = json.dumps(self.content(study), sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:16]


def setting_of(file: StudyFile) -> Setting:
    """Read the plan and the machine that a study names, and check that the machine can follow the circles.

    Raises
    ------
    InputError
        There is no such file, it is wrong, or a circle is out of the machine's reach.
    """
    beside = file.path.parent if file.path is not None else Path()
    plan = load_plan(file.plan if file.plan in shipped_plans() else beside / file.plan)
    asked = {"feeds_mm_min": file.feeds_mm_min, "laps": file.laps}
    changed = {key: value for key, value in asked.items() if value is not None}
    machine = plan.machine_file() if file.machine is None else machine_beside(file.machine, file.path or Path("study"))
    circles = tuple(each.model_copy(update=dict.fromkeys(changed)) for each in plan.circles)
    plan = plan.model_copy(update={**changed, "circles": circles}).with_machine(machine)
    for circle in plan.circles:
        if circle_clearances(machine, circle, plan.mount_of(circle).cup_mm) is None:
            raise InputError(
                f"{file.plan}: circle {circle.id} is out of reach of {machine.name}"
                " (expected a plan that it can drive: hexdbb plan check)"
            )
    stated = plan.gauge.noise_um if plan.gauge.noise_um is not None else ASSUMED_NOISE_UM
    noise_um = stated if file.gauge.noise_um is None else file.gauge.noise_um
    resolution_um = plan.gauge.resolution_um if file.gauge.resolution_um is None else file.gauge.resolution_um
    gauge = GaugeTruth(noise_um=noise_um, resolution_um=resolution_um, range_um=plan.gauge.range_um)
    return Setting(file, plan, machine, gauge).with_gauge(gauge)
