"""From a search to a graded verdict."""

from __future__ import annotations

from dataclasses import dataclass, replace

from hexdbb.diagnosis import Sufficiency
from hexdbb.evidence.fit.admissible import Checked
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.sufficiency import left_over
from hexdbb.evidence.linear.screen import Hypothesis, Known
from hexdbb.evidence.search.beside import with_known_beside, with_known_left
from hexdbb.evidence.search.fine_enough import or_another_beside, or_one_fine_enough, or_one_place
from hexdbb.evidence.search.place import at_its_place, may_say
from hexdbb.evidence.search.refine import refined, refined_forms
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import explains_nearly, of_forms
from hexdbb.evidence.search.sure import Grade, graded, is_for_sure
from hexdbb.evidence.search.tuned import with_numbers_of, with_tuned_numbers
from hexdbb.evidence.search.turning import with_turning
from hexdbb.evidence.verdict.as_forms import as_forms
from hexdbb.evidence.verdict.beside_formulas import with_what_formulas_leave
from hexdbb.evidence.verdict.by_function import is_by_form, or_by_functions, or_by_refinements
from hexdbb.evidence.verdict.by_growth import or_one_that_grows
from hexdbb.evidence.verdict.by_period import with_periods
from hexdbb.evidence.verdict.each_element import or_at_each_element
from hexdbb.evidence.verdict.exchange import of_better_form, settled, with_found_beside
from hexdbb.evidence.verdict.further_elements import with_elements_that_predict
from hexdbb.evidence.verdict.hidden import with_what_forms_hide
from hexdbb.evidence.verdict.known_words import in_known_words
from hexdbb.evidence.verdict.one_cause import is_refined, left_without, without_borrowed_forms
from hexdbb.evidence.verdict.one_element import or_one_element
from hexdbb.evidence.verdict.own_form import with_known_of_form
from hexdbb.evidence.verdict.predicting import (
    or_a_state_that_predicts,
    or_another_that_predicts,
    or_fewer_by_formulas,
    or_one_that_predicts,
)
from hexdbb.evidence.verdict.rivals import rivals_of
from hexdbb.evidence.verdict.same_state import or_at_another_place, or_at_the_rails
from hexdbb.evidence.verdict.second_alone import or_the_second_alone
from hexdbb.evidence.verdict.simple_beside import or_a_simple_one_beside
from hexdbb.evidence.verdict.simpler import in_simple_words
from hexdbb.evidence.verdict.stand_ins import without_stand_ins
from hexdbb.evidence.verdict.two_elements import or_at_two_elements
from hexdbb.evidence.verdict.two_others import or_two_others
from hexdbb.learned import Learned


@dataclass(frozen=True)
class Found:
    """One cause.

    Attributes
    ----------
    hypothesis : Known or Learned
    rivals : tuple of str
        Of another kind, that explain the readings as well.
    alike : tuple of str
        The same effect at other elements, which explains the readings as well.
    margin : float
        Log evidence over the best set of hypotheses that has none of this kind, over what the set leaves.
    refinements : tuple of str
        Learned hypotheses beside it at the same place: how its form differs.
    deviation : float
        Of its form, as a part of its size.
    is_lead : bool
        Whether a learned function at its own place is a cause too: the effect describes a part of what that is.
    """

    hypothesis: Hypothesis
    rivals: tuple[str, ...]
    margin: float
    alike: tuple[str, ...] = ()
    refinements: tuple[str, ...] = ()
    deviation: float = 0.0
    is_lead: bool = False

    @property
    def grade(self) -> Grade:
        """Verdict on this cause alone."""
        if isinstance(self.hypothesis, Known) and not self.is_lead:
            return "ambiguous" if self.rivals else "effect"
        return "ambiguous" if any(not name.startswith("learned:") for name in self.rivals) else "unknown"


@dataclass(frozen=True)
class Verdict:
    """What is missing.

    Attributes
    ----------
    grade : str
    found : tuple of Found
        Causes.
    node : Node
        The set of hypotheses that they are.
    checked : Checked or None
        How it predicts; None where nothing was found.
    sufficiency : Sufficiency
        How much was missing.
    refined : Node or None
        The set with its learned functions refined (`refine.py`); where only forms of the model's effects are left,
        functions that describe them.
    """

    grade: Grade
    found: tuple[Found, ...]
    node: Node
    checked: Checked | None
    sufficiency: Sufficiency
    refined: Node | None = None


def judge(search: Search, matters_um: float | None = None) -> Verdict:
    """Look for all that is missing.

    Parameters
    ----------
    search : Search
    matters_um : float, optional
        Unexplained RMS below which nothing matters; by the default of a diagnosis where not given.
    """
    before = left_over(search.root.trial, search.trials, search.criteria, matters_um)
    if before.is_sufficient:
        return Verdict("none", (), search.root, None, before, refined_forms(search))
    searched = or_one_that_grows(search, or_the_second_alone(search, search.run()))
    first = _in_sure_words(search, or_at_each_element(search, or_at_two_elements(search, searched)))
    other = or_a_state_that_predicts(search, or_another_that_predicts(search, first))
    node = in_known_words(search, other)
    if other is not first:
        node = with_found_beside(search, node)
    if node is search.root:
        if not _is_form(search):
            return Verdict("unknown", (), node, None, before)
        return Verdict("none", (), node, None, before, refined_forms(search))
    # Known words may leave what was a function's shape: what lies beside them is asked for again.
    node = with_known_beside(search, or_two_others(search, settled(search, node)))
    node = with_what_forms_hide(search, node)
    node = without_borrowed_forms(search, of_better_form(search, node))
    node = or_one_that_predicts(search, or_fewer_by_formulas(search, with_elements_that_predict(search, node)))
    node = with_turning(search, with_tuned_numbers(search, or_by_functions(search, node)))
    node = or_another_beside(search, node)
    # What its slider's place says of a leg, the joint of the slider says as well: the rail is asked before and after.
    fine = or_at_the_rails(search, or_one_fine_enough(search, node))
    fine = or_at_the_rails(search, or_at_another_place(search, fine))
    node = or_a_simple_one_beside(search, node if fine is node else in_known_words(search, fine))
    node = with_what_formulas_leave(search, with_known_left(search, node))
    if (forms := as_forms(search, node)) is not None:
        return Verdict("none", (), search.root, None, before, forms)
    node = in_simple_words(search, with_periods(search, node))
    node, wider = or_by_refinements(search, node, refined(search, node))
    node, wider = or_one_place(search, *without_stand_ins(search, node, wider))
    node, wider = with_known_of_form(search, with_numbers_of(search, node, wider), wider)
    outdone = ""
    if (alone := or_one_element(search, node)) is not node:
        node, wider, outdone = alone, refined(search, alone), node.trial.names[0]
    causes, refinements = _grouped(search, node)
    known = {each.name for each in node.hypotheses}
    for each in wider.hypotheses:
        there = (one for one in causes if isinstance(each, Learned) and at_its_place(search, one, each))
        cause = next(there, None)
        if cause is not None and each.name not in known:
            refinements[cause.name] = (*refinements.get(cause.name, ()), each.name)
    found = tuple(
        _found(search, node, cause, refinements.get(cause.name, ()), is_lead=_is_lead(search, node, causes, cause))
        for cause in causes
    )
    found = tuple(_without_rival(each, outdone) for each in found)
    grades = [each.grade for each in found]
    grade: Grade = "unknown" if "unknown" in grades else "ambiguous" if "ambiguous" in grades else "effect"
    return Verdict(graded(search, node, grade), found, node, search.checked(node), before, wider)


def _in_sure_words(search: Search, node: Node) -> Node:
    """Return a set in known words where so it is for sure: in learned ones it might give way to what fits worse."""
    known = in_known_words(search, node)
    return known if known.is_known and is_for_sure(search, known) else node


def _is_form(search: Search) -> bool:
    """Check that what nothing explains is no more than the forms of the effects in the model may be off."""
    return search.root.trial.left - 1.0 < search.criteria.form_named**2 * search.trials.explained_before


def _grouped(search: Search, node: Node) -> tuple[list[Hypothesis], dict[str, tuple[str, ...]]]:
    """Split a set into causes, and learned functions that refine one of them at its own place."""
    causes: list[Hypothesis] = [each for each in node.hypotheses if isinstance(each, Known)]
    refinements: dict[str, tuple[str, ...]] = {}
    learned = [each for each in node.hypotheses if isinstance(each, Learned)]
    for each in _in_order(search, node, learned) if len(learned) > 1 else learned:
        there = (one for one in causes if at_its_place(search, one, each))
        of = next((one for one in there if is_refined(search, node, one, each)), None)
        if of is None:
            causes.append(each)
        else:
            refinements[of.name] = (*refinements.get(of.name, ()), each.name)
    return causes, refinements


def _in_order(search: Search, node: Node, learned: list[Learned]) -> list[Learned]:
    """Sort functions: what explains most first, but a product after the function whose form it describes."""

    def place(each: Learned) -> tuple[bool, float]:
        left = left_without(search, node, each)
        is_form = any(one in each.parts for one in learned) and explains_nearly(search, left, node.trial.left)
        return is_form, -left

    return sorted(learned, key=place)


def _is_lead(search: Search, node: Node, causes: list[Hypothesis], cause: Hypothesis) -> bool:
    """Check for a known effect beside learned functions that one of them may say, or leave by being no more exact.

    So may one that explains more than the effect does: what is not known that far may be at another place too. And what
    explains by the functions of its form more than by its formula takes what the others leave.
    """
    others = [each for each in causes if isinstance(each, Learned)]
    if not isinstance(cause, Known) or not others:
        return False
    if is_by_form(search, node, node.members[node.hypotheses.index(cause)]):
        return True
    if any(may_say(search, cause, each) for each in others):
        return True
    most = max(left_without(search, node, each) for each in others)
    return left_without(search, node, cause) < max(most, node.trial.left + of_forms(search, node.trial))


def _found(search: Search, node: Node, cause: Hypothesis, refinements: tuple[str, ...], *, is_lead: bool) -> Found:
    rivals = rivals_of(search, node, cause)
    form = node.trial.forms[node.hypotheses.index(cause)]
    deviation = 0.0 if form is None else form.deviation
    return Found(cause, rivals.others, rivals.margin, rivals.alike, refinements, deviation, is_lead)


def _without_rival(found: Found, effect: str) -> Found:
    """Return a cause without those rivals that have an effect among them."""
    return replace(found, rivals=tuple(each for each in found.rivals if effect not in each.split(" + ")))
