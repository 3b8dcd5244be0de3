"""From a verdict on hypotheses to causes: fitted in the exact form that would be added, put into words."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis import Sufficiency
from hexdbb.discovery import words
from hexdbb.discovery.candidates import MAX_CHECKED, choice_of, shown_candidates
from hexdbb.discovery.exact_fit import ExactFit, exactly
from hexdbb.discovery.learning import with_learned
from hexdbb.discovery.next_test import next_test
from hexdbb.discovery.result import Candidate, Cause, NextTest, Verdict
from hexdbb.discovery.sentences import likely_sentence, verdict_sentence
from hexdbb.effects.words import effect_clause
from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Trial
from hexdbb.evidence.forms.form import Form
from hexdbb.evidence.forms.function_at_each import function_at_each
from hexdbb.evidence.linear.screen import Hypothesis, Known
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.sure import graded
from hexdbb.evidence.verdict.verdict import Found
from hexdbb.evidence.verdict.verdict import Verdict as Judged
from hexdbb.learned import Learned
from hexdbb.learned.places import EACH
from hexdbb.learned.words import CERTAIN
from hexdbb.model import Model, Size

Floats = NDArray[np.float64]
Judge = Callable[[Model, Floats], Sufficiency]

MORE = "something else is missing besides"


@dataclass(frozen=True)
class Told:
    """What `hexdbb.discovery.discover` makes a `Discovery` of."""

    verdict: Verdict
    sentence: str
    causes: tuple[Cause, ...]
    candidates: tuple[Candidate, ...]
    model: Model
    remaining: Sufficiency | None
    next_test: NextTest | None = None
    remarks: tuple[str, ...] = ()
    likely: str = ""
    learned: Model | None = None
    refinements: tuple[str, ...] = ()


def told(search: Search, judged: Judged, judge: Judge, matters_um: float, with_table: bool = True) -> Told:
    """Describe a verdict.

    Parameters
    ----------
    search : Search
        That led to it.
    judged : Verdict
        Of `hexdbb.evidence`.
    judge : callable
        Judges what a fitted model leaves.
    matters_um : float
        Unexplained RMS from which it matters.
    with_table : bool
        Whether other hypotheses are held out too, for the table.
    """
    if judged.grade == "none":
        refining = () if judged.refined is None else judged.refined.hypotheses
        return _told_forms(search, refining) if search.root.trial.present else _told_nothing(search, judged.sufficiency)
    candidates = shown_candidates(search, judged.node, MAX_CHECKED if with_table else 0)
    if not judged.found or judged.checked is None:
        sentence = "something is missing that nothing tried explains"
        return Told("unknown", sentence, (), candidates, search.engine.base, None)
    shares = {each.hypothesis: _share(search, judged.node, each) for each in judged.found}
    refining = tuple(each.hypothesis for each in judged.found if search.refined(each.hypothesis))
    found = [each for each in judged.found if each.hypothesis not in refining]
    found.sort(key=lambda each: -shares[each.hypothesis])
    found = [each for each in found if _own_size_um(search, judged.node, each, shares) >= matters_um] or found[:1]
    if refining and all(_size_um(search, shares[each.hypothesis]) < matters_um for each in found):
        return _told_forms(search, refining)
    grade = graded(search, judged.node, found[0].grade)
    exact = exactly(search, judged.node.trial, [each.hypothesis for each in found])
    # Of the first each value may be in doubt while all together are not: six drives that lag, or the gauge is late.
    if empty := [each for each in found[1:] if is_nothing(search, judged.node, exact, each.hypothesis)]:
        found = [each for each in found if each not in empty]
        exact = exactly(search, judged.node.trial, [each.hypothesis for each in found])
    hypotheses = [each.hypothesis for each in found]
    names = [each.name for each in hypotheses if isinstance(each, Learned)]
    learned = with_learned(search.engine.samples, exact.model, names, search.engine.noise)
    told_with = _Models(exact, None if learned is None else learned[0])
    causes = tuple(_cause(search, judged.node, each, shares[each.hypothesis], told_with) for each in found)
    if grade == "unknown" != found[0].grade:  # what is not for sure together is no effect for sure alone
        causes = tuple(replace(each, verdict=grade) for each in causes)
    remaining = None if exact.residual_mm is None else judge(exact.model, exact.residual_mm)
    return Told(
        verdict=grade,
        sentence=verdict_sentence(grade, causes, judged.checked.share, judged.checked.heldout),
        causes=causes,
        candidates=candidates,
        model=exact.model,
        remaining=remaining,
        next_test=_next_test(search, found[0], causes[0], exact.model) if grade == "ambiguous" else None,
        remarks=_remarks(search, judged.node.trial, causes, grade, remaining),
        likely=likely_sentence(causes, judged.checked.share, judged.checked.heldout),
        learned=told_with.learned,
    )


def is_nothing(search: Search, node: Node, exact: ExactFit, cause: Hypothesis) -> bool:
    """Check for a known effect of which only the functions of its form explain anything: its values are zero.

    Beside a carriage that is pushed aside by the direction of travel "slider 2 has 0.0 ± 0.3 µm of play".
    """
    if not isinstance(cause, Known):
        return False
    shapes = {each.name for each in search.engine.base.info(cause.effect).parameters if each.is_shape}
    sizes = [each for each in _values(node, exact, cause) if each.name not in shapes]
    return all(abs(each.value) <= CERTAIN * (each.sigma or 0.0) for each in sizes)


def _values(node: Node, exact: ExactFit, known: Known) -> tuple[Size, ...]:
    """Return the values of an effect as they are told.

    Geometry takes what elements share, and one value for all, fitted to how they differ, is of either sign: such are
    told as they were fitted with the law at each.
    """
    form = node.trial.forms[node.hypotheses.index(known)]
    return exact.values_of(known, None if form is None or form.law is None else node.trial.model)


def _told_nothing(search: Search, enough: Sufficiency) -> Told:
    sentence = f"nothing that matters is missing: {enough.sentence}"
    return Told("none", sentence, (), (), search.engine.base, None)


def _told_forms(search: Search, refining: Sequence[Hypothesis] = ()) -> Told:
    """State that nothing remains but the forms of the effects that the model has.

    Parameters
    ----------
    search : Search
    refining : sequence of hypotheses
        That describe the forms, where some were found.
    """
    engine, present = search.engine, search.root.trial.present
    deviating = [(name, form) for name, form in present if form.deviation >= words.SMALLEST_DEVIATION]
    whose = [f"{name} ({words.percent(form.deviation)} off)" for name, form in deviating]
    whose += [name for name in dict.fromkeys(map(search.refined, refining)) if name not in dict(deviating)]
    functions = [each.name for each in refining]
    functions = functions or [name for _, form in deviating for name in form.functions]
    sentence = f"no other cause is missing: what is left is the form of {words.joined(whose or ['what was found'])}"
    remarks = [f"the form is refined by: hexdbb add {each}" for each in functions[:1]]
    if len(functions) > 1:
        remarks.append(
            f"{len(functions)} functions describe it; hexdbb discover --auto --forms adds those that predict"
        )
    return Told("none", sentence, (), (), engine.base, None, None, tuple(remarks), refinements=tuple(functions))


def left_um(search: Search, trial: Trial) -> float:
    """Return the RMS beyond the noise that a trial leaves, forms explained."""
    return float(np.sqrt(max(trial.left - 1.0, 0.0)) * np.mean(search.engine.row_noise_mm)) * 1e3


def _size_um(search: Search, share: float) -> float:
    """Return the RMS of a part of what is unexplained."""
    return left_um(search, search.root.trial) * float(np.sqrt(max(share, 0.0)))


def _own_size_um(search: Search, node: Node, found: Found, shares: dict[Hypothesis, float]) -> float:
    """Return the RMS of what is left without a cause, or of what a known effect pushes where that is more.

    Beyond geometry: other causes and their forms may stand in for most of an effect that is there.
    """
    own = found.hypothesis
    share_um = _size_um(search, shares[own])
    if not isinstance(own, Known):
        return share_um
    noise_um = float(np.mean(search.engine.row_noise_mm)) * 1e3
    return max(share_um, noise_um * float(np.sqrt(search.trials.size(node.trial, own))))


def _remarks(
    search: Search, trial: Trial, causes: Sequence[Cause], grade: Verdict, remaining: Sufficiency | None
) -> tuple[str, ...]:
    """Describe how far forms differ, and state whether something remains beside the causes and their forms."""
    said = (
        []
        if remaining is None or not remaining.is_significant
        else [
            f"the machine's form differs from that of {each.choice} by {words.percent(each.form_deviation)} of its size"
            for each in causes
            if each.form_deviation >= words.SMALLEST_DEVIATION
        ]
    )
    said += [
        f"{each.choice} has one value for all: by what each is larger or smaller is added by: hexdbb add {name}"
        for each in causes
        for name in each.refinements
        if Learned.parse(name).element == EACH
    ]
    beside_um = left_um(search, trial)
    if grade == "effect" and remaining is not None and remaining.matters and beside_um >= remaining.matters_um:
        said.append(f"{MORE}: {beside_um:.2f} µm are left that neither the causes nor their forms explain")
    if causes and not search.learns:
        said.append(words.KNOWN_ALONE)
    return tuple(said)


def _share(search: Search, node: Node, found: Found) -> float:
    """Return the part of the unexplained that is left where a cause is taken out of a set, and what refines it.

    A gauge that bends, by the way it moves too, says all that the plain bend does: beside it that is nothing.
    """
    excess = max(search.root.trial.left - 1.0, 1e-9)
    own = {found.hypothesis.name, *found.refinements}
    others = tuple(each for each in node.members if each.hypothesis.name not in own)
    if not others:
        return (search.root.trial.left - node.trial.left) / excess
    try:
        return (search.trials.of(others).left - node.trial.left) / excess
    except RunError:
        return 0.0


@dataclass(frozen=True)
class _Models:
    """The known causes as they were fitted, and the model with the learned ones that it can hold."""

    exact: ExactFit
    learned: Model | None


def _cause(search: Search, node: Node, found: Found, share: float, models: _Models) -> Cause:
    hypothesis = found.hypothesis
    values: tuple[Size, ...] = ()
    refinements = found.refinements
    if isinstance(hypothesis, Learned):
        term = None if models.learned is None else models.learned.term(hypothesis.name)
        effect = hypothesis.name
        clause = words.place_clause(hypothesis) if term is None else words.function_clause(term)
        elements: tuple[str, ...] = ()
    else:
        effect, elements = hypothesis.effect, hypothesis.elements
        form = node.trial.forms[node.hypotheses.index(hypothesis)]
        values = _values(node, models.exact, hypothesis)
        clause = effect_clause(models.exact.model.info(effect), values)
        refinements = (*_law_at_each(search, form), *refinements)
    return Cause(
        choice=choice_of(hypothesis),
        effect=effect,
        elements=elements,
        verdict=found.grade,
        share=share,
        margin=float(min(found.margin, node.score - search.root.score)),
        form_deviation=found.deviation,
        refinements=refinements,
        function=_function(search, hypothesis),
        alike=tuple(dict.fromkeys(found.alike)),
        rivals=_rivals(search, node, found),
        values=values,
        clause=clause,
    )


def _function(search: Search, cause: Hypothesis) -> str | None:
    """Return the learned function that was tried alone and is a cause without its formula, the best one."""
    if isinstance(cause, Learned):
        return cause.name
    alone = [each for each in search.nodes if len(each.members) == 1 and isinstance(each.hypotheses[0], Learned)]
    alone.sort(key=lambda each: -each.score)
    names = [each.hypotheses[0].name for each in alone if search.same_kind(cause, each.hypotheses[0])]
    return next(iter(names), None)


def _rivals(search: Search, node: Node, found: Found) -> tuple[str, ...]:
    """Return what stands in for a cause in the sets that explain the readings as well, as `hexdbb add` takes it."""
    names = []
    for set_of in found.rivals:
        other = _node_called(search, set_of)
        if other is not None:
            extra = [each for each in other.hypotheses if each not in node.hypotheses]
            names.append(" + ".join(choice_of(each) for each in extra or other.hypotheses))
    return tuple(dict.fromkeys(names))


def _node_called(search: Search, name: str) -> Node | None:
    return next((each for each in search.nodes if " + ".join(each.trial.names) == name), None)


def _law_at_each(search: Search, form: Form | None) -> tuple[str, ...]:
    """Return the function by which elements that share an effect have one size each, where they differ."""
    if form is None or form.law is None or form.unlike < words.SMALLEST_DEVIATION:
        return ()
    return (function_at_each(search.trials.forms.functions, form.law).name,)


def _next_test(search: Search, found: Found, cause: Cause, model: Model) -> NextTest | None:
    """Find the circle that tells the first cause from the first rival whose effects are all known."""
    for set_of, name in zip(found.rivals, cause.rivals, strict=False):
        node = _node_called(search, set_of)
        if node is None or not all(isinstance(each, Known) for each in node.hypotheses):
            continue
        other = exactly(search, node.trial, node.hypotheses).model
        return next_test(search.engine.samples, search.engine.noise, (model, other), (cause.choice, name))
    return None
