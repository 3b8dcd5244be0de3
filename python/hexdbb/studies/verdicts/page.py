"""The page of a verdict study: goals and what was measured, what was called what.

Rates have 95 % intervals (Wilson 1927). A case whose size no machine can have is left out.
"""

from __future__ import annotations

import inspect
import re
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import fields
from typing import Any

import numpy as np
from scipy import stats

from hexdbb.evidence.criteria import DEFAULT, Criteria
from hexdbb.studies.thesis.markdown import markdown_table
from hexdbb.studies.verdicts.outcome import NAMED
from hexdbb_truth.forms import cases as forms

Line = dict[str, Any]
HELD_OUT_GOAL = 1.3
"""Held-out error over the noise once what was found is added."""
EXPECTED_RATIO = 1.5
"""Error over the expected one from which a form is wrong where it was not seen (`Criteria.heldout_ratio`)."""
PAGE = """# How often a verdict is right

Machines with random errors of geometry, set-up and gauge (noise 0.5 µm), on which faults have *forms*: what a catalogue
effect pushes is 0 to 20 % off its formula in a way drawn at random, and faults that the catalogue does not have are
among them. The simulator (`hexdbb_truth.forms`) shares no code with the estimator, nor its forms. Sizes are what a
fault leaves after geometry has been fitted, in multiples of the noise. *Withheld*: the true effect is taken from the
candidates; nothing else may then be named, but for effects that the simulator states to say the same on these circles.
Held-out errors are those of circles left out; a free function of time claims no other circle's time, and is asked of
arcs of every circle.

{cases}

{goals}

![Outcomes over the size of the fault, by deviation of form]({picture})

## Catalogue faults, by kind (3 × noise and more)
{catalogue}

## The true effect withheld
{withheld}

## Faults outside the catalogue
{outside}

## Pairs and triples
{pairs}

Outcomes: *right*; *more* (right, and something else besides); *element* (right effect, wrong element); *lead* (right,
but not named for sure); *ambiguous* with the truth among the named; *variable*, *port* (learned at the right place over
another variable, at the right kind of place); *missed* (called unknown, or nothing); *false* (another effect named for
sure).

## Constants
All in `hexdbb.evidence.criteria.Criteria`. They were chosen on the calibrate half of the forms; the other half judges.

{constants}

Made by `{command}`.
"""


def rate(lines: Sequence[Line], good: Callable[[Line], bool]) -> tuple[int, int]:
    """Return how many lines are good, of how many."""
    return sum(good(each) for each in lines), len(lines)


def shown(counted: tuple[int, int]) -> str:
    """Return a rate as text, with its interval."""
    good, number = counted
    if not number:
        return "no case"
    bounds = stats.binomtest(good, number).proportion_ci(method="wilson")
    return f"{100 * good / number:.1f} % of {number} ({100 * bounds.low:.0f} to {100 * bounds.high:.0f} %)"


def goals(lines: Sequence[Line]) -> list[tuple[str, str, str]]:
    """Return what, goal and measured rate of every row."""
    catalogue = [each for each in lines if is_single(each) and each["hidden"][0]["catalogued"] and not each["withheld"]]
    large = [each for each in catalogue if times_of(each) >= 3.0]
    small = [each for each in catalogue if times_of(each) < 3.0]
    strange = [each for each in lines if is_single(each) and (each["withheld"] or not each["hidden"][0]["catalogued"])]
    strange_large = [each for each in strange if times_of(each) >= 3.0]
    clean = [each for each in lines if not each["hidden"]]
    combined, triples = ([each for each in lines if len(each["hidden"]) == number] for number in (2, 3))
    unequal = [each for each in combined if forms.case(each["case"]).times_each]
    pairs = [each for each in combined if each not in unequal]
    added = [each for each in lines if each.get("after_adding")]
    right_effect = [each for each in large if _is_right_effect(each)]
    seconds = [each["seconds"] for each in lines]
    rows = []
    for times in forms.TIMES_NOISE[1:]:
        at = [each for each in large if times_of(each) == times]
        what = f"catalogue fault at {times:g} × noise, form 0 to 20 % off: main cause right"
        rows.append((what, "≥ 97 %", shown(rate(at, _is_right_effect))))
    for what, goal, of, good in (
        ("the same: element right where the effect is", "≥ 95 %", right_effect, _is_right),
        ("the same: nothing named besides", "", right_effect, lambda each: each["outcome"] != "more"),
        ("catalogue fault at 1.5 × noise: a false name", "≤ 3 %", small, _is_false),
        ("outside the catalogue, and one withheld: confident false name", "≤ 3 %", strange, _is_false),
        ("the same at 3 × and more: learned at the right place and variable", "≥ 90 %", strange_large, _is_right),
        (f"the same: held-out error within {HELD_OUT_GOAL} × noise once added", "≥ 80 %", strange_large, _predicts),
        *_by_size(strange_large),
        ("clean machine: `none`", "≥ 99 %", clean, lambda each: each["grade"] == "none"),
        ("machine whose fault has been added: `none`", "≥ 97 %", added, lambda each: each["after_adding"] == "none"),
        ("pairs at 3 × noise: both, nothing else", "≥ 95 %", pairs, lambda each: each["outcome"] == "right"),
        ("pairs of two sizes, 3 to 30 × noise: the same", "≥ 95 %", unequal, lambda each: each["outcome"] == "right"),
        ("triples at 3 × noise: all, nothing else", "", triples, lambda each: each["outcome"] == "right"),
    ):
        rows.append((what, goal, shown(rate(of, good))))
    if seconds:
        spread = f"median {np.median(seconds):.1f} s, 95 % below {np.quantile(seconds, 0.95):.1f} s"
        rows.append(("CPU time of a verdict with learned search, 10,000 readings", "≤ 6 s", spread))
    return rows


def _by_size(lines: Sequence[Line]) -> Iterator[tuple[str, str, list[Line], Callable[[Line], bool]]]:
    """Yield the rows of held-out error by size, and what the fits to the rest expect of themselves at all sizes."""
    for times in forms.TIMES_NOISE[1:]:
        yield f"- of these at {times:g} × noise", "", [each for each in lines if times_of(each) == times], _predicts
    held = [each for each in lines if _can_predict(each)]
    yield "- of those where the fit to the other circles expects no more of itself", "", held, _predicts
    yield "- of these no more than half beyond what the fit expects", "", list(lines), _as_expected


def page(lines: Sequence[Line], failed: int, picture: str, command: str) -> str:
    """Return the page's text.

    Parameters
    ----------
    lines : sequence of mappings
        Results of cases, as `hexdbb.studies.verdicts.cases.line_of` makes them.
    failed : int
        Cases that could not be run.
    picture : str
        Link to the picture of `curves_figure`.
    command : str
        What made the page.
    """
    tried = [each for each in lines if "outcome" in each]
    failed += sum("failed" in each for each in lines)
    halves = " and ".join(sorted({forms.case(each["case"]).half for each in tried}))
    single = [each for each in tried if is_single(each) and not each["withheld"]]
    pairs = [(_kinds(each), each["outcome"], _called(each)) for each in tried if len(each["hidden"]) > 1]
    return PAGE.format(
        cases=f"{len(tried)} cases of the {halves} half; {failed} failed to run.",
        goals=_table(("what", "goal", "measured"), goals(tried)),
        picture=picture,
        catalogue=_confusion([each for each in single if each["hidden"][0]["catalogued"]]),
        withheld=_confusion([each for each in tried if each["withheld"]]),
        outside=_confusion([each for each in single if not each["hidden"][0]["catalogued"]]),
        pairs=_table(("hidden", "outcome", "called"), pairs),
        constants=_table(("constant", "value", "controls"), _constants()),
        command=command,
    )


def _constants() -> list[tuple[str, str, str]]:
    text = inspect.getdoc(Criteria) or ""
    words = {
        match[1]: " ".join(match[2].split())
        for match in re.finditer(r"^(\w+) : .*\n((?:    .*\n?)+)", text, flags=re.MULTILINE)
    }
    return [(f"`{each.name}`", f"{getattr(DEFAULT, each.name)}", words[each.name]) for each in fields(Criteria)]


def _confusion(lines: Iterable[Line]) -> str:
    kinds: dict[str, list[Line]] = defaultdict(list)
    for each in lines:
        if times_of(each) >= 3.0:
            kinds[_kinds(each)].append(each)
    rows = []
    for kind, of_kind in sorted(kinds.items()):
        outcomes, called = (Counter(f(each) for each in of_kind) for f in (lambda e: e["outcome"], _called))
        rows.append((kind, str(len(of_kind)), _counts(outcomes), _counts(called)))
    return _table(("hidden", "cases", "outcomes", "called most often"), rows)


def _counts(counter: Counter[str]) -> str:
    return ", ".join(f"{name} {number}" for name, number in counter.most_common(4))


def _called(line: Line) -> str:
    names = [re.sub(r":(\d+(,\d+)*|all)(?=:|$)", "", each["name"]).partition("@")[0] for each in line["found"][:3]]
    return " + ".join(names) or line["grade"]


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    return markdown_table(head, rows, left=len(head)).rstrip()


def is_single(line: Line) -> bool:
    """Check whether one fault is hidden."""
    return len(line["hidden"]) == 1


def _is_right(line: Line) -> bool:
    return line["outcome"] in NAMED


def _is_right_effect(line: Line) -> bool:
    return _is_right(line) or bool(line["outcome"] == "element")


def _is_false(line: Line) -> bool:
    return bool(line["outcome"] == "false")


def _predicts(line: Line) -> bool:
    """Check the first grouping that the causes claim to predict: circles, for free functions of time arcs of them."""
    return any(line["heldout"][name]["after"] <= HELD_OUT_GOAL for name in line["claimed"][:1])


def _can_predict(line: Line) -> bool:
    """Check that the other circles hold geometry so well that the true cause would be within the goal."""
    return not any(line["heldout"][name]["expected"] > HELD_OUT_GOAL for name in line["claimed"][:1])


def _as_expected(line: Line) -> bool:
    """Check the error against what a fit to the other circles expects of itself there: no plan shows everything."""
    held = [line["heldout"][name] for name in line["claimed"][:1]]
    return any(each["after"] <= max(HELD_OUT_GOAL, EXPECTED_RATIO * each["expected"]) for each in held)


def times_of(line: Line) -> float:
    """Return the size of what is hidden, in multiples of the noise."""
    return forms.case(line["case"]).times_noise


def _kinds(line: Line) -> str:
    return " + ".join(each["kind"] for each in line["hidden"])
