"""The cases of a verdict study, and what one of them gives: what is hidden, what was found, whether that is right."""

from __future__ import annotations

import itertools
import json
import random
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, replace
from functools import lru_cache
from typing import Any

import pyarrow as pa

from hexdbb import _core
from hexdbb.diagnosis import judging_noise
from hexdbb.discovery import discover
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.verdict.quieter import judged
from hexdbb.evidence.verdict.verdict import Verdict
from hexdbb.ledger import add_effect
from hexdbb.model import Model, new_model
from hexdbb.plan import Plan
from hexdbb.samples import Samples
from hexdbb.studies.setting import Setting
from hexdbb.studies.study import Case, Row
from hexdbb.studies.verdicts.outcome import Named, outcome_of
from hexdbb_truth.forms import cases as forms
from hexdbb_truth.forms import lists
from hexdbb_truth.forms.history import History
from hexdbb_truth.forms.sizes import UnreachableSizeError
from hexdbb_truth.simulate import Pace

CLEAN, PAIRS, UNEQUAL, TRIPLES = 20, 20, 20, 10
"""Clean machines, pairs of one size and of two, triples for each seed of single faults, which are some four hundred."""
WITHHELD_DEVIATION, WITHHELD_TIMES = 0.1, (3.0, 10.0, 30.0)
"""Form deviation and sizes of faults whose effect is withheld: nothing learned is sharper than a form so far off."""
KEPT = 5
"""Rivals of a cause that a row keeps."""
COLUMNS = pa.schema(
    [
        ("case", pa.int64()),
        ("name", pa.string()),
        ("withheld", pa.list_(pa.string())),
        ("outcome", pa.string()),
        ("grade", pa.string()),
        ("found", pa.list_(pa.string())),
        ("seconds", pa.float64()),
        ("line", pa.string()),
    ]
)


def cases(setting: Setting) -> list[Case]:
    """Return the first of the cases asked for by name, or of an endless series that covers every kind of case early.

    Raises
    ------
    InputError
        No case is called so.
    """
    asked = setting.file.verdicts.names
    named = ((forms.case(name).name, ()) for name in asked)
    series = named if asked else _series(setting.file.verdicts.half, setting.file.seed)
    chosen = itertools.islice(series, setting.file.cases)
    return [{"case": case, "name": name, "withheld": list(withheld)} for case, (name, withheld) in enumerate(chosen)]


def _series(half: str, first: int) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield cases and the effects withheld, all kinds of one seed in random order, then those of the next."""
    for seed in itertools.count(first):
        single = [
            *lists.alone(half, seeds=[seed]),
            *lists.outside(half, seeds=[seed]),
            *lists.clean(half, range(CLEAN * seed, CLEAN * (seed + 1))),
            *_of_seed(lists.combined(half, 2, 3.0, PAIRS * (seed + 1)), PAIRS, seed),
            *_of_seed(lists.unequal(half, count=UNEQUAL * (seed + 1)), UNEQUAL, seed),
            *_of_seed(lists.combined(half, 3, 3.0, TRIPLES * (seed + 1)), TRIPLES, seed),
        ]
        every: list[tuple[str, tuple[str, ...]]] = [(each.name, ()) for each in single]
        withheld = lists.alone(half, deviations=(WITHHELD_DEVIATION,), times_noise=WITHHELD_TIMES, seeds=[seed])
        every += [(each.name, each.kinds) for each in withheld]
        random.Random(seed).shuffle(every)
        yield from every


def _of_seed(every: Iterator[forms.Case], count: int, seed: int) -> Iterator[forms.Case]:
    return itertools.islice(every, count * seed, None)


def row(setting: Setting, case: Case) -> Row:
    """Return the line of one case and its columns."""
    line = line_of(_true_case(setting, case["name"]), case["withheld"])
    return {
        **case,
        "outcome": line.get("outcome"),
        "grade": line.get("grade"),
        "found": [each["name"] for each in line.get("found", ())],
        "seconds": line.get("seconds"),
        "line": json.dumps(line, default=float),
    }


def _true_case(setting: Setting, name: str) -> forms.Case:
    file = setting.file
    case = replace(forms.case(name), spread=file.machine_errors, noise_um=setting.gauge.noise_um)
    if file.verdicts.own_plans:
        return case
    return replace(case, plan_name=None, driven=_history(setting.plan, setting.pace))


@lru_cache(maxsize=2)
def _history(plan: Plan, pace: Pace) -> History:
    return History(plan, pace)


def line_of(case: forms.Case, withheld: Sequence[str]) -> dict[str, Any]:
    """Return what became of one case, as JSON can hold it."""
    known = {"case": case.name, "withheld": list(withheld)}
    try:
        labels = case.labels
    except UnreachableSizeError as error:
        return {**known, "unreachable": str(error)}
    record = case.record()
    samples = Samples.of([record])
    model = new_model(record.machine).with_mounts(samples.mounts)
    effects = [each for each in _core.effect_names("catalogue") if each not in withheld]
    began = time.process_time()
    first = Search(Engine(samples, model, judging_noise(samples).noise), effects, DEFAULT)
    search, verdict = judged(first)
    seconds = time.process_time() - began
    found = [Named(each.hypothesis.name, each.grade, each.rivals, each.alike) for each in verdict.found]
    outcome = outcome_of(verdict.grade, found, labels, withheld)
    is_named = outcome == "right" and verdict.grade == "effect"
    return {
        **known,
        "hidden": [asdict(each) for each in labels],
        "grade": verdict.grade,
        "found": [
            {
                "name": each.hypothesis.name,
                "rivals": each.rivals[:KEPT],
                "alike": each.alike[:KEPT],
                "margin": min(each.margin, 1e12),
                "deviation": each.deviation,
                "refinements": each.refinements,
            }
            for each in verdict.found
        ],
        "left": [search.root.trial.left, verdict.node.trial.left],
        **_predicted(search, verdict),
        "seconds": seconds,
        "outcome": outcome,
        "after_adding": _after_adding(samples, model, verdict) if is_named else "",
    }


def _predicted(search: Search, verdict: Verdict) -> dict[str, Any]:
    """Return how the causes predict what was left out, learned ones refined, and which groupings they claim to."""
    if verdict.refined is None:
        return {"heldout": {}, "claimed": []}
    checked = search.checked(verdict.refined)
    heldout = {name: asdict(each) for name, each in checked.heldout.items()}
    return {"heldout": heldout, "claimed": list(checked.claimed)}


def _after_adding(samples: Samples, model: Model, verdict: Verdict) -> str:
    """Return what is said once all that was found has been added."""
    for each in verdict.found:
        model = add_effect(samples, model, each.hypothesis.name).model
    return discover(samples, model).verdict
