"""The study file: which machine, plan and gauge, how far machines differ, and what each study asks of them.

One file serves all studies: its root and the tables `gauge` and `machine_errors` hold for all of them, and each study
has a table of its own. Every key has a default, so that the empty study is that of the shipped machine and plan.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError, model_validator

from hexdbb.errors import InputError
from hexdbb.files.validation import (
    BadValueError,
    FileModel,
    NotNegative,
    Positive,
    StrictModel,
    load_toml,
    validation_line,
)
from hexdbb.machine import shipped_names, shipped_or_own
from hexdbb.rig.mechanisms import CATALOGUED
from hexdbb.rig.truth import Spread

Whole = Annotated[int, Field(ge=1)]
Seed = Annotated[int, Field(ge=0)]
Feeds = Annotated[tuple[Positive, ...], Field(strict=False, min_length=1)]
Names = Annotated[tuple[Annotated[str, Field(min_length=1)], ...], Field(strict=False, min_length=1)]
Range = Annotated[tuple[Positive, Positive], Field(strict=False)]
Levels = Annotated[tuple[Positive, ...], Field(strict=False, min_length=1)]
Share = Annotated[float, Field(ge=0.0, lt=1.0)]
Shares = Annotated[tuple[Annotated[float, Field(gt=0.0, lt=1.0)], ...], Field(strict=False, min_length=1)]
Counts = Annotated[tuple[Whole, ...], Field(strict=False, min_length=1)]
Angle = Annotated[float, Field(ge=0.0, le=90.0)]


class StudyGauge(StrictModel):
    """The gauge that measures true machines."""

    noise_um: NotNegative | None = None
    """Standard deviation of one reading, which its specification states; the plan's where absent, else 0.5."""
    resolution_um: NotNegative | None = None
    """Step to which readings are rounded; that of the plan's gauge where absent."""


class Power(StrictModel):
    """Which sizes of which effects are found."""

    effects: Names = ("backlash", "pitch_cyclic", "gravity_sag", "bar_drift")
    """Effects hidden in the machines, one at a time, of those that the rig has as mechanisms."""
    times_noise: Range = (0.05, 2.0)
    """Least and largest size: root mean square that geometry and set-up leave of the effect, over the noise."""
    clean_share: Share = 0.2
    """Part of the cases without any fault, which give the rate of false names."""
    learned: bool = True
    """Whether functions without a formula are searched for too, as `hexdbb discover` does; false is faster."""


class Coverage(StrictModel):
    """Whether stated intervals contain the truth."""

    levels: Shares = (0.5, 0.68, 0.8, 0.9, 0.95, 0.99)
    """Levels of the intervals that are looked at; 0.95 always is."""


class Verdicts(StrictModel):
    """How often a verdict is right, on faults with forms of their own."""

    half: Literal["calibrate", "judge"] = "judge"
    """Half of the forms: criteria are set on the first and judged on the second."""
    own_plans: bool = True
    """Whether each fault is measured on the plan that can show it; false: all on this study's plan."""
    names: Annotated[tuple[str, ...], Field(strict=False)] = ()
    """Names of cases in place of those drawn, such as `chords_for_arc-d0-x3-judge-s0`, whatever `half` is."""


class PlanSearch(StrictModel):
    """Which circles determine most, searched."""

    circles: Counts = (3, 5, 7)
    """Numbers of circles that are tried in turn."""
    mounts: Whole = 1
    """Largest number of cup positions."""
    criterion: Literal["D", "minmax"] = "D"
    """What a search maximises: the volume of certainty, or the smallest singular value."""
    tilt_deg: Angle = 18.0
    """Largest tilt of the platform."""
    yaw_deg: Angle = 20.0
    """Largest turn of the platform."""
    plane_deg: Angle = 24.0
    """Largest tilt of a circle's plane."""
    bar_angle_deg: Angle = 25.0
    """Largest angle of the bar out of the plane of cup or platform."""
    near: Positive = 0.02
    """Relative distance from the best within which a search counts as having found it too."""


class Tolerance(StrictModel):
    """How good gauge, repeatability and set-up must be: one of them is varied, the others are those of the study."""

    target_um: Positive = 1.0
    """Error of the compensated machine that is asked for: root mean square of the ball's position."""
    noise_um: Levels = (0.1, 0.5, 1.0, 2.0, 5.0)
    """Standard deviation of one reading."""
    repeatability_um: Levels = (0.1, 0.3, 1.0, 3.0)
    """Standard deviation of a slider's position from run to run."""
    scale_error_percent: Levels = (0.1, 0.3, 1.0, 3.0)
    """Scale error of the gauge, either sign."""
    bar_length_um: Levels = (0.3, 1.0, 3.0, 10.0)
    """Standard deviation of the bar's length from what is stated."""
    cup_um: Levels = (30.0, 100.0, 300.0, 600.0)
    """Standard deviation of the cup's position along each axis."""


class StudyFile(FileModel):
    """Validated study file."""

    schema_id: Literal["hexdbb.study/1"] = Field(default="hexdbb.study/1", alias="schema")
    """Kind and version of the file."""
    plan: Annotated[str, Field(min_length=1)] = "standard"
    """Plan file relative to this file, or the name of a shipped plan."""
    machine: Annotated[str, Field(min_length=1)] | None = None
    """Machine file relative to this file, or the name of the shipped one; the plan's where absent."""
    feeds_mm_min: Feeds | None = None
    """Feeds in place of the plan's."""
    laps: Whole | None = None
    """Laps in place of the plan's."""
    rate_hz: Positive = 40.0
    """Readings per second. A controller records more, and more readings find smaller faults; time of computing grows
    with them."""
    cases: Whole = 200
    """Number of simulated cases."""
    seed: Seed = 1
    """Seed of every random number; another seed gives other machines."""
    gauge: StudyGauge = StudyGauge()
    """Gauge that measures the true machines."""
    machine_errors: Spread = Spread()
    """Standard deviations of the errors of the machines and of their set-up."""
    power: Power = Power()
    """What `hexdbb study power` varies and asks for."""
    coverage: Coverage = Coverage()
    """What `hexdbb study coverage` varies and asks for."""
    verdicts: Verdicts = Verdicts()
    """What `hexdbb study verdicts` varies and asks for."""
    plan_search: PlanSearch = PlanSearch()
    """What `hexdbb study plan` varies and asks for."""
    tolerance: Tolerance = Tolerance()
    """What `hexdbb study tolerance` varies and asks for."""

    @model_validator(mode="after")
    def _consistent(self) -> StudyFile:
        low, high = self.power.times_noise
        if low >= high:
            raise BadValueError(("power", "times_noise"), [low, high], "the smaller size first")
        for place, effect in enumerate(self.power.effects):
            if effect not in CATALOGUED:
                raise BadValueError(("power", "effects", place), effect, f"one of {', '.join(CATALOGUED)}")
        return self


def changed(study: StudyFile, changes: Mapping[str, Any], origin: str) -> StudyFile:
    """Return a study with some keys changed, those of a table as a mapping.

    Raises
    ------
    InputError
        A value is wrong; names `origin`, the key, the value and what was expected.
    """
    keys = study.model_dump(by_alias=True)
    for key, value in changes.items():
        keys[key] = {**keys[key], **value} if isinstance(value, Mapping) else value
    try:
        found = StudyFile.model_validate(keys)
    except ValidationError as error:
        raise InputError(f"{origin}: {validation_line(error, StudyFile)}") from None
    found._path = study.path
    return found


def shipped_studies() -> list[str]:
    """Return the names of the studies shipped with the package, sorted."""
    return shipped_names("studies")


def load_study(name_or_path: Path | str) -> StudyFile:
    """Read a study file, or a shipped study by its name.

    Raises
    ------
    InputError
        One line naming file, key, value and what was expected.
    """
    return load_toml(shipped_or_own(name_or_path, "study", "studies"), StudyFile)
