"""One effect at some of its elements: three of six sliders that stick at every reversal, five of six drives that lag.

Fitted at all of them, an effect shows where it is: elements at which it has hardly a size, or the sign that it cannot
have, have none. A lag that all drives share is nearly a delay of the gauge, which geometry and forms take with either
sign: the drive that lags the least then stands for none.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import NOTHING_LEFT, Member, Trial
from hexdbb.evidence.linear.physical import is_one_sided
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.all_elements import FEWEST
from hexdbb.evidence.search.settling import explained

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search


def at_those_seen(search: Search, fewer: Node, members: Sequence[Member], *, one_by_one: bool = False) -> Node | None:
    """Return a set with an effect at the elements at which it is seen, where it is a main cause.

    Parameters
    ----------
    search : Search
    fewer : Node
        The set without the effect, or with it at fewer elements.
    members : sequence of Member
        Of the set, its last the effect at all its elements.
    one_by_one : bool, optional
        Whether only so few elements are meant as are told one by one: of more it is simpler to say that all have it.

    Returns
    -------
    Node or None
        None where the effect is no main cause, or is seen at one element or at all.
    """
    try:
        trial = _of_right_sign(search, search.trials.of(tuple(members)))
        if not _is_main(search, fewer, trial):
            return None
        seen, whole = _seen(search, trial), search.engine.base.info(_effect(trial).effect).elements
        most = FEWEST if one_by_one else len(whole)
        half = len(whole) // 2
        if len(seen) > half:
            # Six that lag may all do so: that some of them do not is said where they are most.
            most = min(most, half + 1) if len(seen) == len(whole) else most
            seen = _seen(search, trial := _without_what_all_share(search, trial, half))
        if not 2 <= len(seen) < most:
            return None
        known = _effect(trial)
        *others, _ = trial.members
        apart = [Known(known.effect, (each,)) for each in seen]
        # Play of three drives beside two other causes is one more than are told apart: it stays one cause.
        is_one = len(seen) >= FEWEST or len(others) + len(apart) > search.criteria.max_effects
        last = [Known(known.effect, seen)] if is_one else apart
        found = (*others, *map(Member, last))
        count_kin(search, last)
        return search.node(found, near=fewer)
    except RunError:
        return None


def _is_main(search: Search, fewer: Node, trial: Trial) -> bool:
    """Check that with an effect far less is left than without it, by more than the forms of the others may leave.

    So it is a main cause, and worth the fits beside it.
    """
    criteria, before = search.criteria, fewer.trial
    is_less = trial.left - 1.0 < criteria.far_better * (before.left - 1.0)
    return is_less and before.left - trial.left > criteria.form_variance * explained(search, before)


def _of_right_sign(search: Search, trial: Trial) -> Trial:
    """Return a trial without the elements at which its last effect has the sign that it cannot have.

    Where most have it, all are off by what they share, and only the one that is the farthest off is left out.
    """
    for _ in range(len(_effect(trial).elements) - 2):
        wrong = of_wrong_sign(search, trial)
        known, *others = _effect(trial), *trial.members[:-1]
        if not wrong:
            break
        out = {min(wrong, key=lambda each: wrong[each])} if 2 * len(wrong) > len(known.elements) else wrong.keys()
        left = tuple(each for each in known.elements if each not in out)
        if len(left) < 2:
            break
        trial = search.trials.of((*others, Member(Known(known.effect, left))))
    return trial


def _without_what_all_share(search: Search, trial: Trial, most: int) -> Trial:
    """Return a trial without the elements at which its last effect is least, one after another, until it is at few.

    What all share may hardly be seen: lags of half a millisecond of all drives are a delay, which geometry and forms
    take, and two drives that lag were six, four of them by what could as well be nothing. So the least stands for none.

    Parameters
    ----------
    search : Search
    trial : Trial
    most : int
        Elements at which it is seen then.

    Returns
    -------
    Trial
        The last one that leaves no more than the one before.
    """
    while len(_seen(search, trial)) > most:
        known = _effect(trial)
        least = min(known.elements, key=lambda each: search.trials.size(trial, Known(known.effect, (each,))))
        left = Known(known.effect, tuple(each for each in known.elements if each != least))
        fewer = search.trials.of((*trial.members[:-1], Member(left)))
        if fewer.left - trial.left > NOTHING_LEFT:
            break
        trial = fewer
    return trial


def of_wrong_sign(search: Search, trial: Trial) -> dict[str, float]:
    """Return the elements at which a trial's last effect has a sign that it cannot have, each with its value."""
    known, model = _effect(trial), trial.model
    info = search.engine.base.info(known.effect)
    return {
        each.element: float(value)
        for each, value in zip(model.parameters(), model.values, strict=True)
        if each.effect == known.effect
        and each.element in known.elements
        and is_one_sided(info, each.name)
        and value < 0.0
    }


def _seen(search: Search, trial: Trial) -> tuple[str, ...]:
    """Return the elements at which a trial's last effect is more than a form of what it is at the others."""
    known = _effect(trial)
    least = search.criteria.form_variance * search.trials.size(trial, known)
    return tuple(each for each in known.elements if search.trials.size(trial, Known(known.effect, (each,))) > least)


def count_kin(search: Search, every: Sequence[Known]) -> None:
    """Count the functions of single elements among the kin of an effect at several."""
    for known in every:
        if known.name not in search.kin:
            search.kin[known.name] = set().union(
                *(search.kin.get(Known(known.effect, (each,)).name, set()) for each in known.elements)
            )


def _effect(trial: Trial) -> Known:
    hypothesis = trial.members[-1].hypothesis
    assert isinstance(hypothesis, Known)
    return hypothesis
