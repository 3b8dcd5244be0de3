"""Rates of right and wrong verdicts on the truth with forms: ``python -m tests.truth.calibration``.

Each case is one line of JSON, appended as soon as it is done, so that a run can be stopped and taken up again; the
table is made from the lines. Cases of the calibrating half set criteria, those of the judging half are only reported.
"""

from __future__ import annotations

import argparse
import itertools
import json
import os
import random
import time
from collections import defaultdict
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from pathlib import Path
from typing import Any

from tests.truth.forms import cases as forms
from tests.truth.forms.labels import Label
from tests.truth.forms.sizes import UnreachableSizeError

from hexdbb import _core
from hexdbb.diagnosis import judging_noise
from hexdbb.discovery import discover
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.engine import Engine
from hexdbb.evidence.search import Search
from hexdbb.evidence.verdict import Verdict, judge
from hexdbb.ledger import add_effect
from hexdbb.model import Model, new_model
from hexdbb.samples import Samples
from hexdbb.threads import one_thread

PLACES = {"lateral": "guideway", "vertical": "guideway"}
VARIABLES = {
    "fine_position": ("position",),
    "screw_phase": ("position",),
    "direction": ("direction",),
    "direction_position": ("direction", "position"),
    "since_reversal_time": ("since_reversal", "direction"),
    "since_reversal_travel": ("since_reversal", "direction"),
    "time_position": ("time", "position"),
    "turning_rate": ("joint_turning",),
    "joint_angle_direction": ("joint_turning", "joint_angle"),
    "swing_rate": ("joint_turning",),
    "platform_turning_rate": ("joint_turning",),
    "platform_joint_angle": ("joint_angle",),
    "swing_angle": ("joint_angle",),
    "angle_direction": ("angle", "direction"),
    "bar_angle": ("angle",),
    "circle_direction": ("direction",),
    "reading": ("deflection",),
    "warming": ("time",),
    "step": ("time",),
    "fine_time": ("time",),
    "roll": ("tilt",),
    "pitch": ("tilt",),
    "time_in_sweep": ("time_in_run",),
    "time_period": ("time",),
    "position_period": ("position",),
}
"""The truth's words for the variables of learned hypotheses, where they differ."""


def wanted(half: str, seeds: int) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield cases and the effects withheld, in an order that covers every row early."""
    every: list[tuple[str, tuple[str, ...]]] = []
    for case in itertools.chain(
        forms.alone(half, seeds=range(seeds)),
        forms.outside(half, seeds=range(seeds)),
        forms.clean(half, range(20 * seeds)),
        forms.combined(half, 2, 3.0, 20 * seeds),
        forms.combined(half, 3, 3.0, 10 * seeds),
    ):
        every.append((case.name, ()))
    for case in forms.alone(half, deviations=(0.1,), times_noise=(3.0, 10.0, 30.0), seeds=range(seeds)):
        every.append((case.name, case.kinds))
    random.Random(7).shuffle(every)
    yield from every


@one_thread
def judged(name: str, withheld: Sequence[str]) -> dict[str, Any]:
    """Return the line of one case: what is hidden, what was found, whether that is right."""
    case = forms.case(name)
    try:
        labels = case.labels
    except UnreachableSizeError as error:
        return {"case": name, "withheld": list(withheld), "unreachable": str(error)}
    record = case.record()
    samples = Samples.of([record])
    model = new_model(record.machine).with_mounts(samples.mounts)
    effects = [each for each in _core.effect_names("catalogue") if each not in withheld]
    began = time.process_time()
    search = Search(Engine(samples, model, judging_noise(samples).noise), effects, DEFAULT)
    verdict = judge(search)
    seconds = time.process_time() - began
    result = outcome(verdict, labels, withheld)
    return {
        "case": name,
        "withheld": list(withheld),
        "hidden": [asdict(each) for each in labels],
        "grade": verdict.grade,
        "found": [
            {
                "name": each.hypothesis.name,
                "rivals": each.rivals[:5],
                "alike": each.alike[:5],
                "margin": min(each.margin, 1e12),
                "deviation": each.deviation,
                "refinements": each.refinements,
            }
            for each in verdict.found
        ],
        "left": [search.root.trial.left, verdict.node.trial.left],
        **_predicted(search, verdict),
        "seconds": seconds,
        "outcome": result,
        "after_adding": _after_adding(samples, model, verdict)
        if result == "right" and verdict.grade == "effect"
        else "",
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


def outcome(verdict: Verdict, labels: Sequence[Label], withheld: Sequence[str]) -> str:
    """Return `right`, `element` (right effect, wrong element), `port`, `variable`, `ambiguous`, `missed` or `false`."""
    hidden = [each for each in labels if each.catalogued and each.kind not in withheld]
    names = [each.hypothesis.name for each in verdict.found]
    if not labels:
        return "right" if verdict.grade == "none" else "false"
    results = []
    for label in labels:
        if label in hidden:
            results.append(_named(verdict, label))
        else:
            results.append(_learned(verdict, label))
    if len(names) > len(labels) and all(each in ("right", "element") for each in results):
        return "more"
    order = ("false", "missed", "ambiguous", "port", "variable", "element", "right")
    return min(results, key=order.index)


def _named(verdict: Verdict, label: Label) -> str:
    accepted = {label.kind, *(each.effect for each in label.equivalents if each.effect)}
    for each in verdict.found:
        effect, _, elements = each.hypothesis.name.partition(":")
        rivals = {name.partition(":")[0] for rival in each.rivals for name in rival.split(" + ")}
        if effect in accepted:
            if each.grade == "ambiguous":
                return "ambiguous"
            right = {str(number) for number in label.elements}
            for alike in each.alike:
                elements += "," + alike.partition(":")[2]
            neighbours = {str(n) for e in label.equivalents if e.effect for n in e.elements or ()}
            named = set(elements.split(","))
            return "right" if not right or effect != label.kind or named & (right | neighbours) else "element"
        if each.grade == "ambiguous" and rivals & accepted:
            return "ambiguous"
    return "false" if verdict.grade == "effect" else "missed"


def _learned(verdict: Verdict, label: Label) -> str:
    truths = [(label.port, label.variables, label.elements)]
    truths += [(each.port, (each.variable,), each.elements) for each in label.equivalents]
    accepted = {each.effect for each in label.equivalents if each.effect}
    best = "missed"
    for each in verdict.found:
        name = each.hypothesis.name
        if not name.startswith("learned:"):
            if verdict.grade == "effect" and name.partition(":")[0] not in accepted:
                return "false"
            continue
        _, place, *rest = name.split(":")
        variable = rest[-1].partition("@")[0]
        element = int(rest[0]) if len(rest) == 2 and rest[0].isdigit() else None
        for port, variables, elements in truths:
            if PLACES.get(place, place) != port or (elements and element is not None and element not in elements):
                continue
            if set(VARIABLES.get(variable, (variable,))) & set(variables):
                return "right"
            best = "variable"
        if best == "missed":
            best = "port"
    return best


def table(lines: Sequence[dict[str, Any]]) -> str:
    """Return the rates by row of the goals, as Markdown."""
    rows: dict[str, list[str]] = defaultdict(list)
    for line in lines:
        if "outcome" not in line:
            rows["unreachable" if "unreachable" in line else "failed"].append("-")
            continue
        rows[_row(line)].append(line["outcome"])
    text = ["| row | cases | outcomes |", "|---|---|---|"]
    for row, outcomes in sorted(rows.items()):
        counts = ", ".join(f"{each} {outcomes.count(each)}" for each in sorted(set(outcomes)))
        text.append(f"| {row} | {len(outcomes)} | {counts} |")
    return "\n".join(text)


def _row(line: dict[str, Any]) -> str:
    hidden = line["hidden"]
    if not hidden:
        return "clean"
    case = forms.case(line["case"])
    if len(hidden) > 1:
        return f"{len(hidden)} faults, {case.times_noise:g} x"
    if line["withheld"]:
        return f"leave one out, {case.times_noise:g} x"
    if not hidden[0]["catalogued"]:
        return f"outside, {case.times_noise:g} x"
    return f"catalogue, {case.times_noise:g} x"


def read_lines(path: Path) -> list[dict[str, Any]]:
    """Return the results in a file, one a line; none where there is no file."""
    if not path.exists():
        return []
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def _safe(task: tuple[str, tuple[str, ...]]) -> dict[str, Any]:
    try:
        return judged(*task)
    except Exception as error:  # one case that fails must not end a night's run; the table counts it
        return {"case": task[0], "withheld": list(task[1]), "failed": f"{type(error).__name__}: {error}"}


def main() -> None:
    """Run what is missing, then print the table."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("lines", type=Path, help="file of results, appended to")
    parser.add_argument("--half", choices=forms.HALVES, default="calibrate")
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--most", type=int, default=0, help="cases to run now; all where not given")
    parser.add_argument("--processes", type=int, default=os.cpu_count(), help="all cores where not given")
    parser.add_argument("--table", action="store_true", help="only print the table")
    asked = parser.parse_args()
    known = {(each["case"], tuple(each["withheld"])) for each in read_lines(asked.lines)}
    tasks = [each for each in wanted(asked.half, asked.seeds) if each not in known]
    tasks = [] if asked.table else tasks[: asked.most or len(tasks)]
    with ProcessPoolExecutor(asked.processes) as pool, asked.lines.open("a", encoding="utf-8") as file:
        for line in pool.map(_safe, tasks):
            file.write(json.dumps(line, default=float) + "\n")
            file.flush()
    print(table(read_lines(asked.lines)))


if __name__ == "__main__":
    main()
