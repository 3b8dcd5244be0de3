"""Which sizes of which effects a plan finds on a machine, and how often a false name is given.

Every case is a machine with random errors of geometry and set-up. Most have one fault, of an effect and a size spread
evenly over the range on a logarithmic scale; the others have none. Each is measured on the plan and judged as by
`hexdbb discover`. A fault counts as named where the verdict names its effect at its element.
Sizes are those of the truth file's mechanisms, in their own units: the play, the amplitude.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pyarrow as pa

from hexdbb.discovery import discover
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb.studies.curves import DetectionCurve
from hexdbb.studies.rates import share
from hexdbb.studies.setting import Setting
from hexdbb.studies.study import Case, Result, Row, Sheet, Study, number, percent
from hexdbb.studies.verdicts.outcome import NAMED, Named, outcome_of
from hexdbb.units import readable_unit
from hexdbb_truth.cases import amount_of, drawn, element_of, unit_of
from hexdbb_truth.forms.labels import VARIABLES, Label, equivalents
from hexdbb_truth.simulate import simulate
from hexdbb_truth.sizes import AbsorbedError, sized

GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0
"""Fraction of the range from one case's size to the next's: fills it evenly whatever the number of cases."""
ABSORBED = "absorbed"
"""Outcome of a fault that geometry and set-up absorb on this plan whatever its size."""
SIZES_FOUND = (0.5, 0.95)
"""Probabilities at which sizes are stated: as often found as not, and nearly always."""
COLUMNS = pa.schema(
    [
        ("case", pa.int64()),
        ("machine", pa.int64()),
        ("effect", pa.string()),
        ("element", pa.int64()),
        ("times_noise", pa.float64()),
        ("size", pa.float64()),
        ("unit", pa.string()),
        ("verdict", pa.string()),
        ("found", pa.list_(pa.string())),
        ("outcome", pa.string()),
    ]
)


def cases(setting: Setting) -> list[Case]:
    """Return clean machines among machines with faults, effect after effect, sizes spread over the range."""
    asked, found = setting.file.power, list[Case]()
    low, high = (math.log(each) for each in asked.times_noise)
    for case in range(setting.file.cases):
        clean = math.floor((case + 1) * asked.clean_share) - math.floor(case * asked.clean_share)
        fault = case - math.floor(case * asked.clean_share)
        effect = None if clean else asked.effects[fault % len(asked.effects)]
        part = (0.5 + GOLDEN * (fault // len(asked.effects))) % 1.0
        times_noise = None if clean else math.exp(low + part * (high - low))
        found.append(
            {"case": case, "machine": setting.number(case), "effect": effect, "times_noise": times_noise},
        )
    return found


def row(setting: Setting, case: Case) -> Row:
    """Return what is said of one machine."""
    truth, plan, pace = setting.machine_of(case["machine"]), setting.plan, setting.pace
    hidden: dict[str, object] = {"element": None, "size": None, "unit": None}
    labels: tuple[Label, ...] = ()
    if case["effect"] is not None:
        kind = case["effect"]
        mechanism = drawn(kind, truth.seed)
        element = element_of(mechanism)
        hidden = {"element": element, "size": None, "unit": unit_of(kind)}
        try:
            mechanism = sized(mechanism, truth, plan, pace, case["times_noise"])
        except AbsorbedError:
            return {**case, **hidden, "verdict": None, "found": [], "outcome": ABSORBED}
        hidden["size"] = amount_of(mechanism)
        elements = () if element is None else (element,)
        labels = (Label(kind, True, "", elements, VARIABLES[kind], equivalents(kind, elements)),)
        truth = truth.model_copy(update={"mechanism": (mechanism,)})
    samples = Samples.of([simulate(truth, plan, truth.seed, pace)])
    said = discover(samples, new_model(setting.machine), known_only=not setting.file.power.learned, with_tables=False)
    causes = [Named(each.choice, each.verdict, each.rivals, each.alike) for each in said.causes]
    return {
        **case,
        **hidden,
        "verdict": said.verdict,
        "found": [each.name for each in causes],
        "outcome": outcome_of(said.verdict, causes, labels),
    }


def curve_of(rows: Sequence[Row], effect: str) -> DetectionCurve | None:
    """Return how likely faults of an effect are named, over their sizes; None where no case has a size."""
    own = [each for each in rows if each["effect"] == effect and each["size"] is not None]
    if not own:
        return None
    return DetectionCurve.of([each["size"] for each in own], [each["outcome"] in NAMED for each in own])


def result(setting: Setting, rows: Sequence[Row]) -> Result:
    """Return the sizes that are found, and the rates of false names."""
    from hexdbb.studies.power_picture import power_figure

    effects = [effect for effect in setting.file.power.effects if any(each["effect"] == effect for each in rows)]
    curves = {effect: curve_of(rows, effect) for effect in effects}
    units = {effect: readable_unit(unit_of(effect)) for effect in effects}
    sheets = (
        Sheet(
            "sizes that are named, effect and element",
            ("effect", "unit", "cases", "50 % size", "95 % bounds", "95 % size", "95 % bounds"),
            tuple(_sizes(effect, units[effect], curve) for effect, curve in curves.items()),
            names=2,
        ),
        Sheet("what is said", ("machines", "said", "cases", "share %", "95 % bounds"), _said(rows), names=2),
    )
    answer = tuple(_sentence(effect, units[effect], curve) for effect, curve in curves.items())
    return Result((*answer, _false_sentence(rows)), sheets, lambda: power_figure(rows, curves, units))


def _sizes(effect: str, unit: str, curve: DetectionCurve | None) -> tuple[str, ...]:
    if curve is None:
        return (effect, unit, "0", "absorbed by geometry and set-up", "-", "-", "-")
    found = (text for level in SIZES_FOUND for text in number(curve.size_found(level)))
    return (effect, unit, str(len(curve.size)), *found)


def _sentence(effect: str, unit: str, curve: DetectionCurve | None) -> str:
    if curve is None:
        return f"{effect}: geometry and set-up absorb it on this plan, whatever its size"
    size = curve.size_found(SIZES_FOUND[1])
    if not np.isfinite(size.value):
        return f"{effect}: up to {curve.size.max():.3g} {unit}, the largest tried, not named in 95 % of the machines"
    value, bounds = number(size)
    return f"{effect}: named in 95 % of the machines from {value} {unit} on (95 % bounds {bounds})"


def _false_sentence(rows: Sequence[Row]) -> str:
    clean = [each for each in rows if each["effect"] is None]
    faulty = [each for each in rows if each["effect"] is not None and each["outcome"] != ABSORBED]
    on_clean = percent(share(sum(each["outcome"] == "false" for each in clean), len(clean)))
    on_faulty = percent(share(sum(each["outcome"] == "false" for each in faulty), len(faulty)))
    return (
        f"something is said to be missing on {on_clean[0]} % of the clean machines ({on_clean[1]} %),"
        f" a false name is given to {on_faulty[0]} % of the faults ({on_faulty[1]} %)"
    )


def _said(rows: Sequence[Row]) -> tuple[tuple[str, ...], ...]:
    groups = {
        "clean": [each for each in rows if each["effect"] is None],
        "with a fault": [each for each in rows if each["effect"] is not None and each["outcome"] != ABSORBED],
    }
    asked = {
        "clean": (("nothing is missing", ("right",)), ("something is missing", ("false",))),
        "with a fault": (
            ("named, effect and element", NAMED),
            ("named, another element", ("element",)),
            ("ambiguous, unknown or nothing", ("ambiguous", "missed")),
            ("a false name", ("false",)),
        ),
    }
    return tuple(
        (machines, said, str(len(own)), *percent(share(sum(each["outcome"] in outcomes for each in own), len(own))))
        for machines, own in groups.items()
        for said, outcomes in asked[machines]
    )


STUDY = Study("power", "Which sizes of which effects are found?", COLUMNS, cases, row, result)
