"""Whether a learned function acts where a cause does, so that it may be a part of that cause's form."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hexdbb.evidence.linear.screen import Hypothesis
from hexdbb.evidence.linear.signatures import all_varying
from hexdbb.evidence.proposals.periods import periods
from hexdbb.evidence.proposals.proposals import proposals
from hexdbb.learned import Learned, part_of
from hexdbb.learned.combined import is_slow

if TYPE_CHECKING:
    from hexdbb.evidence.fit.trial import Trial
    from hexdbb.evidence.linear.readings import Linear
    from hexdbb.evidence.search.search import Search

Places = set[tuple[str, int]]
"""Parts of the machine and their elements."""
CLOCKS = frozenset({"time_s", "time_in_circle_s", "time_since_fixing_s"})
"""Columns that are time, whatever the machine does; time within a sweep goes with its reversals."""


def at_its_place(search: Search, cause: Hypothesis, learned: Learned) -> bool:
    """Check that a learned function acts at an element where a cause does; a known effect acts at those of its kin."""
    return any(learned.is_within(part_of(home), home.element) for home in homes_of(search, cause))


def at_a_place_of_its_kin(search: Search, cause: Hypothesis, learned: Learned) -> bool:
    """Check the same of all that a cause's form reads like, at another port too."""
    return any(learned.is_within(part_of(home), home.element) for home in kin_of(search, cause))


def may_say(search: Search, cause: Hypothesis, learned: Learned) -> bool:
    """Check that a function may say what a cause does, by its form: at a place of its kin, and by time only if they do.

    A guideway that is lifted now and then is no play of its slider.
    """
    there = [home for home in kin_of(search, cause) if learned.is_within(part_of(home), home.element)]
    if not _is_by_clock(learned):
        return bool(there)
    return any(_is_by_clock(home) or is_slow(home.variable) for home in there)


def _is_by_clock(learned: Learned) -> bool:
    """Whether a function is one of time alone."""
    return learned.variable.column in CLOCKS and not learned.variable.times


def homes_of(search: Search, cause: Hypothesis) -> list[Learned]:
    """Return the learned functions in which a cause lives: itself, or those of a known effect's kin at its own ports.

    At another port a form reads the same and goes wrong otherwise.
    """
    kin = kin_of(search, cause)
    if isinstance(cause, Learned):
        return kin
    ports = search.engine.absent.ports(cause.effect)
    return [each for each in kin if each.port in ports]


def functions_at(search: Search, trial: Trial, linear: Linear, places: Places | None = None) -> list[Learned]:
    """Return the functions at some places, or at those of the causes, those of single elements where a cause has all.

    What changes with time is no form of what does not.

    Parameters
    ----------
    search : Search
    trial : Trial
        Of the causes.
    linear : Linear
        About it, by which the readings propose functions.
    places : set of (str, int), optional
    """
    causes = [each.hypothesis for each in trial.members]
    places = places or {(part_of(each), each.element) for cause in causes for each in homes_of(search, cause)}
    known = {each.name for each in causes}
    readings, criteria = search.engine.readings, search.criteria
    with_time = trial.is_free_in_time

    def is_there(learned: Learned) -> bool:
        return any(learned.is_within(*place) for place in places) and (with_time or not learned.is_of_time)

    proposed = (
        proposals(linear, readings, search.thinned, criteria)
        if with_time
        else [*periods(linear, readings, criteria, is_there)]
    )
    search.learnable.propose(proposed)
    of_forms = all_varying(readings, of_forms=True)
    further = search.learnable.further.values() if any(map(search.learnable.is_further, causes)) else ()
    by_direction = (each.by_direction for each in causes if isinstance(each, Learned))
    every = dict.fromkeys(
        (
            *(*search.learnable.simple, *of_forms, *search.learnable.products, *further),
            *(each.hypothesis for each in proposed),
            *filter(None, by_direction),
        )
    )
    return [each for each in every if each.name not in known and is_there(each)]


def kin_of(search: Search, cause: Hypothesis) -> list[Learned]:
    """Return the learned functions that contain a cause's form: itself, or a known effect's kin at any port."""
    if isinstance(cause, Learned):
        return [cause]
    by_name = search.learnable.by_name
    return [by_name[name] for name in search.kin.get(cause.name, set()) if name in by_name]
