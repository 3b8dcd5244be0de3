"""Search for what is missing: sets of hypotheses, grown one by one, every set decided by a joint full fit.

Each step screens all hypotheses beside those of a set (`screen.py`) and fits the best in full (`trials.py`). Where one
hypothesis leaves no more than its set's form may, the search ends; else the best few sets are followed (beam search),
so that two faults of one size, of which either alone explains half, are found together.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cache, cached_property

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import RunError
from hexdbb.evidence.criteria import Criteria
from hexdbb.evidence.fit.admissible import Checked, check
from hexdbb.evidence.fit.formula import left_by_formulas
from hexdbb.evidence.fit.heldout import first_error
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member, Trial
from hexdbb.evidence.fit.trials import Trials
from hexdbb.evidence.forms.form import Form
from hexdbb.evidence.forms.homes import Homes
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.screen import Hypothesis, Known, Scored, Screen
from hexdbb.evidence.linear.sums import Sums
from hexdbb.evidence.linear.thinned import Thinned
from hexdbb.evidence.proposals.learnable import Learnable
from hexdbb.evidence.search.beam import followed, needed
from hexdbb.evidence.search.beside import with_known_beside
from hexdbb.evidence.search.expansion import expanded
from hexdbb.evidence.search.fine_enough import or_one_fine_enough
from hexdbb.evidence.search.known_together import or_known_together
from hexdbb.evidence.search.last_resort import LAST_RESORTS, tried_last
from hexdbb.evidence.search.needed import best_of
from hexdbb.evidence.search.number import with_best_number
from hexdbb.evidence.search.settling import is_complete, is_doubtful, predicts, rests_on_form
from hexdbb.evidence.search.several import as_one_cause, is_at_most, is_of_several, or_at_several
from hexdbb.evidence.search.together import Together
from hexdbb.learned import ALL, Learned, settling
from hexdbb.learned.places import EACH

Floats = NDArray[np.float64]


@dataclass
class Search:
    """Search on the rows of one engine.

    Parameters
    ----------
    engine : Engine
    known : sequence of str
        Effects of the catalogue and the user's that may be the cause.
    criteria : Criteria
    learns : bool
        Whether learned hypotheses are looked at.
    """

    engine: Engine
    known: Sequence[str]
    criteria: Criteria
    learns: bool = True
    trials: Trials = field(init=False)
    nodes: list[Node] = field(init=False, default_factory=list)
    """All sets tried."""

    def __post_init__(self) -> None:
        fitted = self.engine.linearised(self.engine.start)
        geometry = self.engine.geometry(fitted)
        # An effect that the model has already has its home too: what its own values take away is not geometry's.
        linear = replace(fitted.linear, own=fitted.linear.own[:, geometry], standing=fitted.linear.standing[geometry])
        readings = self.engine.readings
        self.learnable = Learnable(readings, learns=self.learns)
        rows = self.criteria.thinned_rows if self.learns else self.criteria.fewest_rows
        self.thinned = Thinned(readings, rows, self.criteria.ranking_roughness)
        words = (*self.learnable.simple, *self.learnable.products)
        self.homes = Homes(linear, self.thinned, words, self.criteria, self.learnable.of_forms)
        self.trials = Trials(self.engine, self.homes, self.criteria)
        self.root = Node(self.trials.of(()), self.trials.of(()).log_evidence)
        self.nodes.append(self.root)
        self.expanded: dict[tuple[frozenset[str], bool], list[Node]] = {}
        """Sets with one hypothesis more, by the names of those expanded and whether functions were learned."""
        self._checked: dict[int, Checked] = {}
        self._first_errors: dict[int, float] = {}
        self.screened_known: dict[int, list[Scored]] = {}
        """Known effects screened beside trials, by the identity of these, all of which are kept."""
        self.known_sets: dict[int, list[Together]] = {}
        """Sets of known effects beside nothing, by how many there are at most."""
        self._by_formulas: dict[int, float] = {}
        self.sure_together: Node | None = None
        """Known effects beside nothing that are what they are by formulas, once these were looked for."""

    def forget(self) -> None:
        """Release tables that can be made anew, as where another search is made: they are most of its memory."""
        self.__dict__.pop("_beside_nothing", None)
        self.trials.forget()
        self.thinned.forget()
        self.engine.readings.state.forget()

    @cached_property
    def kin(self) -> dict[str, set[str]]:
        """Names of the learned hypotheses that are an effect's element in other words, by the element's name."""
        signatures, whose = self.engine.absent.signatures(self.engine.start, self.known)
        found: dict[str, set[str]] = {}
        for (effect, element, _, _), homes in zip(whose, self.homes.of_each(signatures), strict=True):
            name = Known(effect, (element,), self.is_whole(effect)).name
            every = (same for each in homes for same in (each.hypothesis, *settling(each.hypothesis)))
            found.setdefault(name, set()).update(each.name for each in every)
        return found

    @cached_property
    def present(self) -> dict[str, list[Learned]]:
        """Learned hypotheses that contain the effects which the model has already, by the element's name."""
        fitted = self.engine.linearised(self.engine.start)
        geometry, parameters = self.engine.geometry(fitted), fitted.model.parameters()
        found: dict[str, list[Learned]] = {}
        for place in np.flatnonzero(~geometry):
            each = parameters[fitted.free[place]]
            name = Known(each.effect, (each.element,), self.is_whole(each.effect)).name
            homes = self.homes.of(fitted.linear.own[:, place])
            found.setdefault(name, []).extend(home.hypothesis for home in homes)
        return found

    def refined(self, hypothesis: Hypothesis) -> str:
        """Return the effect of the model at whose place a learned hypothesis acts; empty where there is none."""
        if isinstance(hypothesis, Known):
            return ""
        for name, homes in self.present.items():
            for home in homes:
                if home.place == hypothesis.place and home.element in (hypothesis.element, ALL):
                    return name
        return ""

    def run(self) -> Node:
        """Return the best set of hypotheses; the empty one where nothing is found."""
        best, beam = self.root, [self.root]
        together, learns = self.root, self.learns
        for size in range(self.criteria.max_effects):
            starts = beam[: self.criteria.max_expansions - len(self.expanded)]
            children = needed(self, (child for node in starts for child in expanded(self, node, learns)))
            beam = followed(self, children)
            best = best_of(self, best, (each for each in beam if predicts(self, each)))
            if size == 0 and self.sure_together is not None:
                together = best = self.sure_together
            elif size == 0 and self.learns and not (best.members and best.is_known):
                best = or_one_fine_enough(self, best)
            if size == 0 and best is not together and self._asks_for_sets(best):
                together = or_known_together(self, best)
                # Several that leave something stand in for what nobody knows: what is learned may still be better.
                best = together if is_complete(self, together) else best
            for screened_last, is_enough in LAST_RESORTS if learns else ():
                if is_enough(self, best):
                    continue
                last = (child for node in starts for child in tried_last(self, node, screened_last, best))
                found = needed(self, last)
                children = [*children, *found]
                beam = followed(self, children)
                best = best_of(self, best, (each for each in found if predicts(self, each)))
                if size == 0 and found and not best.is_known:
                    best = or_one_fine_enough(self, best)
            if size == 0 and len(together.members) > 1:
                beam = [together, *beam]
            if not beam:
                break
            if is_complete(self, best) and not (is_doubtful(self, best) and rests_on_form(self, best.trial)):
                # A free function of time explains any drift: known effects beside each other are looked at further.
                beam = [each for each in beam if each.is_known] if best.trial.is_of_time else []
                learns = False
        return with_known_beside(self, or_at_several(self, best_of(self, best, [together])))

    def _asks_for_sets(self, best: Node) -> bool:
        """Check that what explains most alone leaves something, or is only excused, or explains much by its form."""
        is_more = best.trial.left > self.criteria.refined_to or self.checked(best).excused
        return is_more or rests_on_form(self, best.trial)

    def node(self, members: Sequence[Member], near: Node) -> Node:
        """Return the node of a set, its score told from that of a near one where it was not reached by a step."""
        trial = self.trials.of(tuple(members))
        for each in self.nodes:
            if each.trial is trial:
                return each
        prior = float(np.log(len(self.learnable.simple))) * (len(near.members) - len(trial.members))
        found = Node(trial, near.score + trial.log_evidence - near.trial.log_evidence + prior)
        self.nodes.append(found)
        return found

    def checked(self, node: Node) -> Checked:
        """Return how a set predicts what is held out, and what speaks against it."""
        return self.checked_trial(node.trial)

    def checked_trial(self, trial: Trial) -> Checked:
        """Return the same of a trial, whether it is of a node or not."""
        if id(trial.model) not in self._checked:
            self._checked[id(trial.model)] = check(trial, self.root.trial, self.trials, self.criteria)
        return self._checked[id(trial.model)]

    def first_error(self, trial: Trial) -> float:
        """Return how a trial predicts the first grouping that it claims; of many tried, few are checked further."""
        if id(trial.model) not in self._first_errors:
            self._first_errors[id(trial.model)] = first_error(trial, self.root.trial, self.trials)
        return self._first_errors[id(trial.model)]

    def left_by_formulas(self, trial: Trial) -> float:
        """Return the mean square (noise variances) that a trial leaves without the functions of forms.

        The law of an effect that all legs share may be of another size at each.
        """
        if id(trial.model) not in self._by_formulas:
            self._by_formulas[id(trial.model)] = left_by_formulas(trial.forms, self.trials.with_laws_at_each(trial))
        return self._by_formulas[id(trial.model)]

    def left_by_formula(self, trial: Trial, form: Form | None) -> float:
        """Return the same without the functions of one form alone."""
        return left_by_formulas([form], self.trials.with_laws_at_each(trial, form))

    def same_kind(self, one: Hypothesis, other: Hypothesis) -> bool:
        """Check whether two hypotheses are one cause in different words."""
        if isinstance(one, Known) and isinstance(other, Known):
            return one.effect == other.effect and not set(one.elements).isdisjoint(other.elements)
        if isinstance(one, Known):
            return not isinstance(other, Known) and self._is_kin(one, other)
        if isinstance(other, Known):
            return self._is_kin(other, one)
        return (one.place, one.element) == (other.place, other.element)

    def _is_kin(self, known: Known, learned: Learned) -> bool:
        """Check whether a function contains an effect.

        Steps contain a drift where other functions of time do, a leg what the rail under its slider does.
        """
        kin = self.kin.get(known.name, set())
        if learned.name in kin:
            return True
        homes = [_home(name) for name in kin]
        if not learned.variable.instants:
            return any(each.is_but_finer(learned) or each.is_at_the_rail_of(learned) for each in homes)
        return any(each.is_of_time and (each.place, each.element) == (learned.place, learned.element) for each in homes)

    def screen(self, node: Node) -> Screen:
        """Return what scores hypotheses beside those of a set; beside nothing, one that keeps what it has scored."""
        return self._beside_nothing if node is self.root else self._screen(node)

    @cached_property
    def _beside_nothing(self) -> Screen:
        return self._screen(self.root)

    def _screen(self, node: Node) -> Screen:
        sums = Sums(self.trials.linear(node.trial), self.engine.readings, ("circle",))
        return Screen(sums, self.criteria, self.thinned)

    def tried(self, node: Node, every: Sequence[Scored]) -> list[Node]:
        """Fit sets with one more hypothesis each in full; a function is there once, with however many splines."""
        found = []
        more = [self.member(each) for each in every if each.hypothesis.name not in node.trial.names]
        sets = [as_one_cause(self, (*node.members, each)) for each in more]
        for fitted in self.trials.each_of(each for each in sets if each is not None):
            try:
                trial = fitted()
            except RunError:
                continue
            if is_of_several(trial.members[-1].hypothesis):
                if not is_at_most(self, trial):
                    continue
            else:
                trial = with_best_number(self, trial, trial.members[-1].hypothesis)
            prior = sum(map(self.log_prior, {each.hypothesis for each in trial.members} - set(node.hypotheses)))
            score = node.score + trial.log_evidence - node.trial.log_evidence + prior
            found.append(Node(trial, score))
        return found

    def log_prior(self, hypothesis: Hypothesis) -> float:
        """Return the log of one over the number of its sort, and what the choice of its instants or period costs."""
        if isinstance(hypothesis, Learned):
            return self.learnable.log_prior(hypothesis)
        return -float(np.log(max(len(self.kin), 1)))

    def count_as(self, hypothesis: Learned, same: Learned) -> None:
        """Let a hypothesis stand for one that it was made of: its choice costs as much, it is the same cause."""
        self.learnable.count_as(hypothesis, same)
        for names in self.kin.values():
            if same.name in names:
                names.add(hypothesis.name)

    def is_whole(self, effect: str) -> bool:
        """Check whether an effect has one element only, so that its name needs none."""
        return len(self.engine.base.info(effect).elements) == 1

    def member(self, scored: Scored, most_seen: int | None = None) -> Member:
        """Return a screened hypothesis with the prior that full fits give it, of so many directions at most."""
        if isinstance(scored.hypothesis, Learned):
            # What has few splines on many axes is asked on all of them: a load's direction is in the sum. Six elements
            # have their directions.
            # Steps from sweep to sweep are as many as there are sweeps.
            steps, is_each = scored.hypothesis.variable.instants, scored.hypothesis.element == EACH
            shared = 1 if scored.hypothesis.variable.is_coarse or is_each or steps else scored.hypothesis.components
            least = self.criteria.most_tuned if steps else self.criteria.most_seen
            most = max(most_seen or 0, least) // shared if steps else (most_seen or least) // shared
            seen = scored.marginal.seen(self.criteria.least_seen, most)
            return Member(scored.hypothesis, seen, scored.marginal.size)
        return Member(scored.hypothesis)


@cache
def _home(name: str) -> Learned:
    """Return a home by its name: sets are compared thousands of times, by the same few."""
    return Learned.parse(name)
