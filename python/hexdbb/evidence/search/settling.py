"""Whether a set of hypotheses settles what is missing: explains it all, predicts, and does not miss most elsewhere."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from hexdbb.evidence.fit.trial import NOTHING_LEFT
from hexdbb.evidence.search.place import homes_of
from hexdbb.learned import ALL, Learned
from hexdbb.learned.places import SHARED

if TYPE_CHECKING:
    from hexdbb.evidence.fit.node import Node
    from hexdbb.evidence.fit.trial import Trial
    from hexdbb.evidence.search.search import Search


def predicts(search: Search, node: Node) -> bool:
    """Check that nothing held out speaks against a set."""
    return not search.checked(node).reasons


def is_complete(search: Search, node: Node) -> bool:
    """Check that a set leaves no more of what was missing than a form of its effects may."""
    excess = search.root.trial.left - 1.0
    return node.trial.left - 1.0 < max(search.criteria.complete * excess, NOTHING_LEFT)


def leaves_nothing(search: Search, node: Node) -> bool:
    """Check that a set explains all, and predicts what is left out to within what its fit expects of itself."""
    return is_complete(search, node) and errs_as_expected(search, node)


def errs_as_expected(search: Search, node: Node) -> bool:
    """Check that a set predicts what is left out to within what its fit expects of itself."""
    ratio = search.criteria.heldout_ratio * max(node.trial.left, 1.0) ** 0.5
    return all(held.after <= ratio * held.expected for held in search.checked(node).heldout.values())


def explains_all_alone(search: Search, node: Node) -> bool:
    """Check that a set is one known effect that leaves no more than its form may."""
    return len(node.members) == 1 and node.is_known and is_complete(search, node) and not node.trial.refused


def leaves_room(search: Search, node: Node) -> bool:
    """Check that a set leaves as much as one more effect would have to explain (`is_better`)."""
    return node.trial.left - 1.0 >= max(must_explain(search, node.trial), NOTHING_LEFT)


def must_explain(search: Search, trial: Trial) -> float:
    """Return what a further effect must explain of what a set leaves, in noise variances: more than forms may hide."""
    return search.criteria.form_described**2 * explained(search, trial)


def explained(search: Search, trial: Trial) -> float:
    """Return what a set and the effects in the model explain, in noise variances."""
    return search.root.trial.left - trial.left + search.trials.explained_before


def settles(search: Search, node: Node) -> bool:
    """Check that nothing less simple need be looked at: a set explains, and predicts, what is missing.

    A free function of time never settles it: it explains whatever drifts, and claims no other time. A platform that
    warms was called a gauge that drifts beside legs that grow, since a function of time said all but that.
    """
    if node.trial.is_of_time:
        return False
    if node.trial.refused or not is_complete(search, node) or not predicts(search, node):
        return False
    if misses_most(search, node):
        return False
    if not node.is_known:
        return leaves_nothing(search, node) and (leaves_no_structure(search, node) or _is_shared(node))
    return not (leaves_room(search, node) or rests_on_form(search, node.trial))


def leaves_no_structure(search: Search, node: Node) -> bool:
    """Check that a set leaves too little to tell what else bends, or turns over, as its functions do."""
    return node.trial.left < search.criteria.leaves_structure


def _is_shared(node: Node) -> bool:
    """Check for a function that all elements share: what it leaves is how they differ (`refine.py`)."""
    return any(isinstance(each, Learned) and each.element == ALL and each.place in SHARED for each in node.hypotheses)


def rests_on_form(search: Search, trial: Trial) -> bool:
    """Check for known effects whose forms explain more than forms may be off.

    Where geometry takes most of an effect its own form may, and so may another effect.
    """
    return search.left_by_formulas(trial) - trial.left > of_forms(search, trial)


def of_forms(search: Search, trial: Trial) -> float:
    """Return what the forms of a set, and of the effects in the model, may explain, in noise variances."""
    return search.criteria.form_variance * explained(search, trial)


def explained_by_formulas(search: Search, node: Node) -> float:
    """Return the part of the unexplained that effects explain without the functions of their forms."""
    return (search.root.trial.left - search.left_by_formulas(node.trial)) / max(search.root.trial.left - 1.0, 1e-9)


def leaves_what_forms_do(search: Search, node: Node) -> bool:
    """Check that formulas leave no more than forms do that are 20 % off: a joint off its place left 0.03 of it.

    A ball with fourteen lobes left 0.09 of what a joint off its place by 0.25 mm explained of them.
    """
    return explained_by_formulas(search, node) >= 1.0 - search.criteria.form_as_seen**2


def explains_by_formulas(search: Search, trial: Trial) -> bool:
    """Check that effects explain enough to be a cause without the functions of their forms."""
    first = search.root.trial.left
    return first - search.left_by_formulas(trial) >= search.criteria.explained_min * (first - 1.0)


def missed(search: Search, node: Node) -> float:
    """Return the error of what was left out, beyond what is expected of it, over what is explained where fitted.

    With the functions of forms: an effect whose form leads away is one of which something else may be true. But where
    the formulas of several explain enough alone, they are what makes them fit, and what they predict counts; that of
    one, where it explains nearly all and predicts as it is expected to. Where the formula of one explains enough, so
    does what a function predicts that contains it at its own place, and explains no more: the form is that function's.
    """
    checked, by_formulas = search.checked(node), explained_by_formulas(search, node) if node.is_known else 0.0
    if by_formulas < search.criteria.explained_min:
        return checked.missed
    if len(node.members) > 1:
        return checked.missed_at_least
    if by_formulas >= search.criteria.form_explains and errs_as_expected(search, node):
        return checked.missed_at_least
    same = (search.checked(each).missed for each in _in_its_functions(search, node))
    return min((checked.missed, *same))


def _in_its_functions(search: Search, node: Node) -> Iterator[Node]:
    """Yield the learned functions tried that contain the one effect of a set at its own place, and explain no more.

    A free function of time predicts nothing.
    """
    alone = [each for each in search.nodes if len(each.members) == 1 and not each.trial.is_of_time]
    as_good = [each for each in alone if explains_nearly(search, node.trial.left, each.trial.left)]
    homes = homes_of(search, node.hypotheses[0]) if as_good else []
    yield from (each for each in as_good if each.hypotheses[0] in homes)


def explains_nearly(search: Search, one: float, other: float) -> bool:
    """Check that what leaves so much explains nearly as much as what leaves the other."""
    return one - other < search.criteria.same_kind_share * (search.root.trial.left - 1.0)


def misses_most(search: Search, node: Node) -> bool:
    """Check whether a set errs on what was left out by about as much as all that it explains where fitted."""
    return missed(search, node) > search.criteria.missed_most


def is_doubtful(search: Search, node: Node) -> bool:
    """Check whether a set stands although it does not predict: excused by its form, or one that misses most."""
    return search.checked(node).excused or misses_most(search, node)
