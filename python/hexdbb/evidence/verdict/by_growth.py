"""One function that grows towards an end by the place, where several effects of one kind grow to say it.

A set of known effects that is for sure ends the search before further functions are looked at. A rail one end of which
a tank warms was the screw of one slider that shrank and that of another, on another guideway, that grew: for sure, with
a hundred nats less than the rail. Few functions grow so, and they are looked at here.
"""

from __future__ import annotations

from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.refine import finely_tuned
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import explains_nearly, predicts
from hexdbb.learned import Learned
from hexdbb.learned import variables as v
from hexdbb.learned.further import SETTLING_POSITION

TRIED = 2
"""Functions that are fitted in full: a rail and the leg of one slider on it grow nearly alike."""


def or_one_that_grows(search: Search, node: Node) -> Node:
    """Return a set with one function that grows by the place, instead of several effects of one kind that do.

    Parameters
    ----------
    search : Search
    node : Node
        Returned unchanged if it has no two such effects, or no such function has more evidence and predicts.
    """
    effects = [each.hypothesis.effect for each in node.members if isinstance(each.hypothesis, Known)]
    several = next((each for each in effects if effects.count(each) > 1 and _grows(search, node, each)), None)
    if several is None or not (search.learns and node.is_known):
        return node
    others = [each for each in node.members if getattr(each.hypothesis, "effect", None) != several]
    base = search.node(others, near=node) if others else search.root
    further = search.learnable.further.values()
    growing = [each for each in further if each.variable in SETTLING_POSITION]
    tried = search.tried(base, search.screen(base).learned(growing)[:TRIED])
    nearly = [each for each in tried if explains_nearly(search, each.trial.left, node.trial.left)]
    tuned = [finely_tuned(search, each) for each in nearly if not each.trial.refused]
    better = [each for each in tuned if each.score - node.score > search.criteria.margin_nats]
    found = [each for each in better if predicts(search, each)]
    search.nodes += [each for each in found if not any(each is other for other in search.nodes)]
    return max(found, key=lambda each: each.score, default=node)


def _grows(search: Search, node: Node, effect: str) -> bool:
    """Check for an effect that lives in functions of the place that grow with time."""
    names = (each.hypothesis.name for each in node.members if getattr(each.hypothesis, "effect", None) == effect)
    kin = {each for name in names for each in search.kin.get(name, set())}
    return any(Learned.parse(each).variable == v.TIME_POSITION for each in kin)
