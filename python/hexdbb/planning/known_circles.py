"""What is known of candidate circles, each computed once: a search comes to the same circle many times."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from hexdbb.machine import MachineFile
from hexdbb.plan import Plan
from hexdbb.planning.candidates import CandidateCircle, within_reach
from hexdbb.planning.clearances import RequiredClearances
from hexdbb.planning.information import Information, PlannedUnknowns, information_of


class KnownCircles:
    """Reach and information of circles for one purpose.

    Parameters
    ----------
    template : Plan
        Feeds, directions and laps of every circle.
    machine : MachineFile
    required : RequiredClearances
    unknowns : PlannedUnknowns
    """

    def __init__(
        self, template: Plan, machine: MachineFile, required: RequiredClearances, unknowns: PlannedUnknowns
    ) -> None:
        self.template, self.machine, self.required, self.unknowns = template, machine, required, unknowns
        self._reached: dict[CandidateCircle, bool] = {}
        self._information: dict[CandidateCircle, Information] = {}

    def within_reach(self, candidates: Iterable[CandidateCircle]) -> list[CandidateCircle]:
        """Return those that the machine can follow with the required clearances."""
        asked = list(candidates)
        new = [each for each in asked if each not in self._reached]
        reached = set(within_reach(new, self.template, self.machine, self.required))
        self._reached.update((each, each in reached) for each in new)
        return [each for each in asked if self._reached[each]]

    def information(self, candidates: Sequence[CandidateCircle]) -> Information:
        """Return the information of candidates about one cup, circle by circle."""
        new = [each for each in candidates if each not in self._information]
        if new:
            found = information_of(new, self.template, self.unknowns)
            self._information.update((each, found.total([place])) for place, each in enumerate(new))
        known = [self._information[each] for each in candidates]
        return Information(
            np.concatenate([each.shared for each in known]),
            np.concatenate([each.cross for each in known]),
            np.concatenate([each.own for each in known]),
        )
