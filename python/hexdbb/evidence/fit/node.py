"""A set of hypotheses that a search has tried."""

from __future__ import annotations

from dataclasses import dataclass

from hexdbb.evidence.fit.trial import Member, Trial
from hexdbb.evidence.linear.screen import Hypothesis, Known
from hexdbb.learned.places import members


@dataclass(frozen=True, eq=False)
class Node:
    """A set of hypotheses with its trial and score: log evidence with the hypotheses' prior probabilities."""

    trial: Trial
    score: float

    @property
    def members(self) -> tuple[Member, ...]:
        """Hypotheses of the set, in the order found."""
        return self.trial.members

    @property
    def hypotheses(self) -> tuple[Hypothesis, ...]:
        """The same without their priors."""
        return tuple(each.hypothesis for each in self.trial.members)

    def member(self, hypothesis: Hypothesis) -> Member:
        """Return the member of a hypothesis."""
        return self.members[self.hypotheses.index(hypothesis)]

    @property
    def is_known(self) -> bool:
        """Whether all are known effects."""
        return all(isinstance(each, Known) for each in self.hypotheses)

    @property
    def faults(self) -> int:
        """How many faults they are: an effect at several elements is one at each, a function of a pair one of both."""
        return sum(len(each.elements if isinstance(each, Known) else members(each.element)) for each in self.hypotheses)

    def without(self, member: Member) -> tuple[Member, ...]:
        """Return the others of a member of the set."""
        return tuple(each for each in self.members if each is not member)
