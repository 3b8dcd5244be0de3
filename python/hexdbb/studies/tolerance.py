"""How good gauge, repeatability and set-up must be for the machine to go where it is told once it is compensated.

One of them is varied at a time, the others are those of the study. Every case is a machine that is measured so and
diagnosed; what counts is how far its ball then still is from where the model has it, over the workspace, a rigid motion
of the base removed: the error of the machine compensated by that model. Machines are the same at every level.
A set-up so far off that the gauge's range is exceeded cannot be measured; it misses the target.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import pyarrow as pa

from hexdbb.errors import InputError
from hexdbb.rig.mechanisms import MECHANISMS, MechanismTable
from hexdbb.rig.truth import TruthFile, random_truth
from hexdbb.studies.measured import diagnosed, place_errors
from hexdbb.studies.rates import Bounded, quantile, share
from hexdbb.studies.setting import Setting
from hexdbb.studies.study import Case, Result, Row, Sheet, Study, number, percent
from hexdbb_truth.repeatability import Approach

WANTED = 0.95
"""Part of the machines that is to meet the target."""
COLUMNS = pa.schema(
    [
        ("case", pa.int64()),
        ("machine", pa.int64()),
        ("factor", pa.string()),
        ("level", pa.float64()),
        ("before_um", pa.float64()),
        ("after_um", pa.float64()),
        ("stated_um", pa.float64()),
        ("refused", pa.string()),
    ]
)


Measured = tuple[TruthFile, Setting]
"""A true machine, and what it is measured with."""


def _noise(truth: TruthFile, level: float, setting: Setting) -> Measured:
    gauge = truth.gauge.model_copy(update={"noise_um": level})
    return truth.model_copy(update={"gauge": gauge}), setting.with_gauge(gauge)


def _repeatability(truth: TruthFile, level: float, setting: Setting) -> Measured:
    return _with_mechanism(truth, Approach(sigma_um=level, seed=truth.seed)), setting


def _scale_error(truth: TruthFile, level: float, setting: Setting) -> Measured:
    signed = level if truth.seed % 2 else -level
    return _with_mechanism(truth, MECHANISMS["bar_gain"].model_validate({"error_percent": signed})), setting


def _bar_length(truth: TruthFile, level: float, setting: Setting) -> Measured:
    error_um = level * float(np.random.default_rng([truth.seed, 1]).normal())
    set_up = truth.setup.model_copy(update={"bar_length_error_um": error_um})
    return truth.model_copy(update={"setup": set_up}), setting


def _cup(truth: TruthFile, level: float, setting: Setting) -> Measured:
    spread = setting.file.machine_errors.model_copy(update={"cup_um": level})
    return truth.model_copy(update={"setup": random_truth(truth.seed, spread).setup}), setting


def _with_mechanism(truth: TruthFile, mechanism: MechanismTable) -> TruthFile:
    return truth.model_copy(update={"mechanism": (mechanism,)})


FACTORS: Mapping[str, tuple[str, str, Callable[[TruthFile, float, Setting], Measured]]] = {
    "noise_um": ("noise of one reading", "µm", _noise),
    "repeatability_um": ("repeatability of a slider from run to run", "µm", _repeatability),
    "scale_error_percent": ("scale error of the gauge", "%", _scale_error),
    "bar_length_um": ("error of the bar's length", "µm", _bar_length),
    "cup_um": ("error of the cup's position along each axis", "µm", _cup),
}
"""What is varied, by its key in the study file: name, unit, and how a machine becomes one of a level."""


def levels(setting: Setting) -> list[tuple[str, float]]:
    """Return every factor with every level of it."""
    asked = setting.file.tolerance
    return [(factor, level) for factor in FACTORS for level in getattr(asked, factor)]


def cases(setting: Setting) -> list[Case]:
    """Return every level of every factor in turn, machine after machine."""
    every = levels(setting)
    return [
        {
            "case": case,
            "machine": setting.number(case // len(every)),
            "factor": every[case % len(every)][0],
            "level": every[case % len(every)][1],
        }
        for case in range(setting.file.cases)
    ]


def row(setting: Setting, case: Case) -> Row:
    """Return how far one machine is off once it is compensated."""
    _, _, changed = FACTORS[case["factor"]]
    truth, measured = changed(setting.machine_of(case["machine"]), case["level"], setting)
    try:
        found = diagnosed(truth, measured)
    except InputError as error:
        return {**case, "before_um": None, "after_um": None, "stated_um": None, "refused": str(error)}
    return {**case, **vars(place_errors(truth, setting, found)), "refused": None}


def result(setting: Setting, rows: Sequence[Row]) -> Result:
    """Return the error that each level leaves, and up to which one the target is met."""
    from hexdbb.studies.tolerance_picture import tolerance_figure

    target_um = setting.file.tolerance.target_um
    groups = {
        (factor, level): [each for each in rows if each["factor"] == factor and each["level"] == level]
        for factor, level in levels(setting)
    }
    groups = {key: own for key, own in groups.items() if own}
    medians = {key: _error(own, 0.5) for key, own in groups.items()}
    upper = {key: _error(own, WANTED) for key, own in groups.items()}
    meeting = {key: _meeting(own, target_um) for key, own in groups.items()}
    stated = {key: _stated(own) for key, own in groups.items()}
    head = (
        "varied",
        "level",
        "unit",
        "machines",
        "error µm",
        "95 % bounds",
        "stated µm",
        "meet target %",
        "95 % bounds",
    )
    lines = tuple(
        (
            FACTORS[factor][0],
            f"{level:g}",
            FACTORS[factor][1],
            str(len(own)),
            *number(medians[factor, level]),
            stated[factor, level],
            *percent(meeting[factor, level], 0),
        )
        for (factor, level), own in groups.items()
    )
    title = f"error of the compensated machine, median; target {target_um:g} µm"
    answer = tuple(
        _sentence(factor, meeting, target_um) for factor in FACTORS if any(key[0] == factor for key in groups)
    )
    sheet = Sheet(title, head, lines)
    return Result(answer, (sheet,), lambda: tolerance_figure(medians, upper, target_um))


def _error(rows: Sequence[Row], level: float) -> Bounded:
    """Return a quantile of the error; what could not be measured is infinitely far off."""
    return quantile([np.inf if each["after_um"] is None else each["after_um"] for each in rows], level)


def _stated(rows: Sequence[Row]) -> str:
    values = [each["stated_um"] for each in rows if each["stated_um"] is not None]
    return f"{np.median(values):.2g}" if values else "-"


def _meeting(rows: Sequence[Row], target_um: float) -> Bounded:
    good = sum(each["after_um"] is not None and each["after_um"] <= target_um for each in rows)
    return share(good, len(rows))


def _sentence(factor: str, meeting: Mapping[tuple[str, float], Bounded], target_um: float) -> str:
    """Return the largest level up to which enough machines meet the target, as found and as shown by the bounds."""
    name, unit, _ = FACTORS[factor]
    own = sorted((level, each) for (of, level), each in meeting.items() if of == factor)
    good = [level for index, (level, _) in enumerate(own) if all(each.value >= WANTED for _, each in own[: index + 1])]
    if not good:
        return f"{name}: not even at {own[0][0]:g} {unit} do 95 % of the machines come within {target_um:g} µm"
    most = "the largest tried" if good[-1] == own[-1][0] else f"not at {own[len(good)][0]:g} {unit}"
    at = own[len(good) - 1][1]
    return (
        f"{name}: up to {good[-1]:g} {unit} ({most}) 95 % of the machines come within {target_um:g} µm"
        f" ({percent(at, 0)[0]} % of {at.number}, bounds {percent(at, 0)[1]} %)"
    )


STUDY = Study("tolerance", "How good must gauge, repeatability and set-up be?", COLUMNS, cases, row, result)
