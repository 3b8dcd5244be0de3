"""What a search screens beside a set: known effects, sets of them, learned functions, and what readings propose."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.fit.trial import Trial
from hexdbb.evidence.forms.homes import Homes
from hexdbb.evidence.linear.physical import is_one_sided
from hexdbb.evidence.linear.readings import Linear
from hexdbb.evidence.linear.screen import Hypothesis, Known, Scored, Screen
from hexdbb.evidence.linear.signatures import varying
from hexdbb.evidence.linear.sums import Sums
from hexdbb.evidence.linear.thinned import Thinned
from hexdbb.evidence.proposals.periods import vibrations
from hexdbb.evidence.proposals.proposals import proposals
from hexdbb.evidence.proposals.two_states import relays
from hexdbb.evidence.proposals.waves import waves
from hexdbb.evidence.search.place import kin_of
from hexdbb.evidence.search.shortlist import better_shaped
from hexdbb.evidence.search.together import KnownSets, Together
from hexdbb.learned import Learned, is_directed, part_of

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search

Floats = NDArray[np.float64]
FINER_TIMES = 4
"""Multiple of splines with which functions are screened again where nothing settles: with 48 over its range the true
one of a dent is ahead of what imitates it, and tuning doubles them as often as it must."""


def screened(search: Search, base: Trial, screen: Screen, *, learns: bool) -> tuple[list[Scored], list[Scored]]:
    """Screen all hypotheses beside those of a trial: known effects, and learned functions where they are looked at.

    Parameters
    ----------
    search : Search
    base : Trial
    screen : Screen
        Of its linearisation.
    learns : bool
        Whether learned functions are looked at.
    """
    known = known_beside(search, base, screen)
    if not learns:
        return known, []
    engine = search.engine
    signatures, whose = engine.absent.signatures(base.model, search.known)
    proposed = proposals(screen.sums.linear, engine.readings, search.thinned, search.criteria)
    search.learnable.propose(proposed)
    _add_kin(search, screen.sums.linear, [each.hypothesis for each in proposed], signatures, whose)
    every = [*search.learnable.simple, *(each.hypothesis for each in proposed)]
    # Beside none: what is fine beside another cause describes what its form leaves.
    return known, screen.learned(_absent(base, every), finely=not base.members)


def known_beside(search: Search, base: Trial, screen: Screen) -> list[Scored]:
    """Screen the known effects beside those of a trial; what was screened once is kept.

    Parameters
    ----------
    search : Search
    base : Trial
    screen : Screen
        Of its linearisation.
    """
    kept = search.screened_known
    if id(base.model) not in kept:
        kept[id(base.model)] = _known_beside(search, base, screen)
    return list(kept[id(base.model)])


def known_by_formulas(search: Search, base: Trial) -> list[Scored]:
    """Screen the known effects beside those of a trial without the functions of their forms, the likeliest first."""
    readings = search.engine.readings
    linear = search.engine.linearised(base.model).linear
    linear = linear.moved(Sums(linear, readings, ()).whole.own_values())
    screen = Screen(Sums(linear, readings, ("circle",)), search.criteria, search.thinned)
    return sorted(_known_beside(search, base, screen), key=lambda each: -each.log_evidence)


def _known_beside(search: Search, base: Trial, screen: Screen) -> list[Scored]:
    absent = search.engine.absent
    kinds = {name for name in search.known if search.is_whole(name)}
    scored = screen.known(*absent.signatures(base.model, search.known), kinds)
    shaped = [name for name in search.known if absent.has_shape(name)]
    for shape in filter(None, search.criteria.shape_starts if shaped else ()):
        scored = better_shaped(scored, screen.known(*absent.signatures(base.model, shaped, shape), kinds))
    present = {each.hypothesis for each in base.members}
    return [each for each in scored if each.hypothesis not in present]


def screened_further(search: Search, base: Trial, screen: Screen) -> list[Scored]:
    """Screen the further learned hypotheses beside those of a trial, and what readings propose besides.

    Products, memory, neighbours and pairs; two states, vibrations, waves of changing amplitude.

    Parameters
    ----------
    search : Search
    base : Trial
    screen : Screen
        Of its linearisation.
    """
    present = {each.hypothesis for each in base.members}
    along = {_directed(each) for each in present} - {None}
    every = [e for e in _absent(base, search.learnable.further.values()) if _directed(e) not in along]
    linear, readings = screen.sums.linear, search.engine.readings
    proposed = [
        *relays(linear, readings, search.criteria),
        *vibrations(linear, readings),
        *waves(linear, readings, search.criteria),
    ]
    search.learnable.propose(proposed)
    found = screen.learned([*every, *varying((each.hypothesis for each in proposed), readings)])
    _add_kin_of_best(search, base, screen, found)
    return found


def _add_kin_of_best(search: Search, base: Trial, screen: Screen, found: list[Scored]) -> None:
    """Count the best further functions among the kin of the known effects whose form they contain.

    Those products that lend no functions to a known effect's form may still say the same as one, and so may those that
    push in both directions of a guideway.
    """
    products = {*search.learnable.products}
    best = [each.hypothesis for each in found if isinstance(each.hypothesis, Learned)]
    others = [each for each in best if (each.variable.times or each.components > 1) and each not in products]
    if others:
        _add_kin(search, screen.sums.linear, others, *search.engine.absent.signatures(base.model, search.known))


def screened_finer(search: Search, base: Trial, screen: Screen) -> list[Scored]:
    """Screen the functions beside those of a trial with several times as many splines, at other places than its own.

    Of a dent or a kink few splines describe so little that another place is looked at. At the place of a known effect
    fine functions describe its form, and no other lap.

    Parameters
    ----------
    search : Search
    base : Trial
    screen : Screen
        Of its linearisation.
    """
    criteria, readings = search.criteria, search.engine.readings
    every = _elsewhere(search, base, (*search.learnable.simple, *search.learnable.further.values()))
    finer = [each.finer(FINER_TIMES) for each in every if each.variable.may_be_finer]
    few = [each for each in finer if each.size <= criteria.most_finer]
    return _screened_once(search, screen, list(varying(few, readings)))


def screened_crossed(search: Search, base: Trial, screen: Screen) -> list[Scored]:
    """Screen the functions that are looked at last beside those of a trial, at other places than its own.

    Parameters
    ----------
    search : Search
    base : Trial
    screen : Screen
        Of its linearisation.
    """
    every = (each for each in search.learnable.crossed.values() if not each.variable.is_anew)
    return _screened_once(search, screen, _elsewhere(search, base, every))


def screened_anew(search: Search, base: Trial, screen: Screen) -> list[Scored]:
    """Screen what is another with each sweep, after all else: it contains whatever stays in a sweep.

    Parameters
    ----------
    search : Search
    base : Trial
    screen : Screen
        Of its linearisation.
    """
    every = (each for each in search.learnable.crossed.values() if each.variable.is_anew)
    return _screened_once(search, screen, _elsewhere(search, base, every))


def _screened_once(search: Search, screen: Screen, every: list[Learned]) -> list[Scored]:
    """Screen functions on few rows: signatures of thousands of functions are large, and serve once."""
    criteria = search.criteria
    thinned = Thinned(search.engine.readings, criteria.fewest_rows, criteria.ranking_roughness, keeps=False)
    return Screen(screen.sums, criteria, thinned).learned(every)


def _elsewhere(search: Search, base: Trial, every: Iterable[Learned]) -> list[Learned]:
    """Return the functions that a trial does not have, at other places than those of its members."""
    taken = {(part_of(home), home.element) for member in base.members for home in kin_of(search, member.hypothesis)}
    return [each for each in _absent(base, every) if not any(each.is_within(*place) for place in taken)]


def _absent(base: Trial, every: Iterable[Learned]) -> list[Learned]:
    """Return the functions that a trial does not have, with however many splines."""
    return [each for each in every if each.name not in base.names]


def _directed(hypothesis: Hypothesis) -> tuple[str, str] | None:
    """Return the place and the vector of a function along a direction: along two directions it is one cause."""
    if isinstance(hypothesis, Known) or not is_directed(hypothesis.variable):
        return None
    return hypothesis.place, hypothesis.variable.name.partition("@")[0]


def in_other_words(search: Search, known: list[Scored], learned: list[Scored], chosen: list[Scored]) -> list[Scored]:
    """Return known effects whose own functions explain much although their exact form does not.

    Parameters
    ----------
    search : Search
    known, learned : list of Scored
        Screened.
    chosen : list of Scored
        Those that get a full fit anyway.
    """
    there = {each.hypothesis for each in chosen}
    found: dict[Scored, float] = {}
    for each in known:
        homes = search.kin.get(each.hypothesis.name, set())
        most = max((one.log_evidence for one in learned if one.hypothesis.name in homes), default=-np.inf)
        if each.hypothesis not in there and most > max(each.log_evidence, 0.0):
            found[each] = most
    return sorted(found, key=lambda each: -found[each])[: search.criteria.in_other_words]


def known_sets(search: Search, most: int) -> list[Together]:
    """Return the sets of two to so many known effects that are worth a full fit, small ones first; kept."""
    if most not in search.known_sets:
        search.known_sets[most] = known_sets_beside(search, search.root.trial, most)
    return search.known_sets[most]


def known_sets_beside(search: Search, base: Trial, most: int) -> list[Together]:
    """Return the sets of two to so many known effects that are worth a full fit beside a set, small ones first."""
    model, engine, criteria = base.model, search.engine, search.criteria
    tables = [engine.absent.signatures(model, search.known)]
    if shaped := [name for name in search.known if engine.absent.has_shape(name)]:
        tables += [engine.absent.signatures(model, shaped, each) for each in filter(None, criteria.shape_starts)]
    sums = Sums(search.trials.linear(base), engine.readings, ())
    screen = Screen(sums, criteria, search.thinned)
    kinds = {name for name in search.known if search.is_whole(name)}
    every = ((engine.base.info(name), each.name) for name in search.known for each in engine.base.info(name).parameters)
    one_sided = {(info.name, name) for info, name in every if is_one_sided(info, name)}
    sets = KnownSets(screen, [each for each, _ in tables], [each for _, each in tables], kinds, criteria, one_sided)
    return sets.best(most, criteria.most_of_one_effect)


def add_kin(search: Search, learned: Sequence[Learned]) -> None:
    """Count learned functions among the kin of the known effects whose form they contain, about the model as it is."""
    root = search.root.trial
    _add_kin(search, search.trials.linear(root), learned, *search.engine.absent.signatures(root.model, search.known))


def _add_kin(
    search: Search,
    linear: Linear,
    proposed: Sequence[Learned],
    signatures: Floats,
    whose: Sequence[tuple[str, str, str, float]],
) -> None:
    """Count what is proposed among the kin of known effects whose form it contains: a pitch error is periodic."""
    homes = Homes(linear, search.thinned, proposed, search.criteria).of_each(signatures)
    for (effect, element, _, _), found in zip(whose, homes, strict=True):
        name = Known(effect, (element,), search.is_whole(effect)).name
        same = {each.hypothesis.name for each in found if each.explained >= search.criteria.same_form}
        search.kin.setdefault(name, set()).update(same)
