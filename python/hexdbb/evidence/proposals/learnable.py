"""The learned hypotheses of a search: simple ones, further ones, those that the readings propose; and their priors."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property

import numpy as np

from hexdbb.evidence.linear.readings import Readings
from hexdbb.evidence.linear.screen import Hypothesis
from hexdbb.evidence.linear.signatures import all_varying, varying
from hexdbb.evidence.proposals.proposed import Proposal
from hexdbb.learned import ALL, Learned, crossed_hypotheses, further_hypotheses, grown_with_warmth, products
from hexdbb.learned.numbered import step
from hexdbb.learned.repeating import by_mount
from hexdbb.learned.variables import BAR_AZIMUTH

MOST_CIRCLES = 24
"""Beginnings of circles, from which on what sits otherwise in each is left to functions of time: these have no more
values (`homes.MOST_COLUMNS`)."""

SAME_ANGLE = 1e-3
"""Mean of 1 - cos(difference) below which two angles count as the same variable: 2.6 degrees RMS, a sixth of the width
of a spline over them."""
ALIKE = 1e-3
"""Part of the variance of the platform's position, not explained by the circle's angle, below which functions of either
are considered equal. For a fault of three times the noise the two then differ by 0.1 times the noise, which is fifty
nats in 10,000 readings; with more, the readings identify the right one."""
PLACE = frozenset({"position_mm", "radius_mm"})
"""Columns that follow from the platform's place."""


def _is_said_already(learned: Learned, readings: Readings) -> bool:
    """Check for a function of the bar's azimuth if that equals the circle's angle or the bar's platform angle."""
    if learned.variable != BAR_AZIMUTH:
        return False
    state = readings.state
    apart = (state["bar_azimuth_rad"] - state[other] for other in ("angle_rad", "bar_angle_rad"))
    return any(float(np.mean(1.0 - np.cos(each))) < SAME_ANGLE for each in apart)


def by_circle(readings: Readings) -> list[Learned]:
    """Return what lets ball and cup sit otherwise in every circle: steps where one begins.

    Such are forms of what sits otherwise after a change of the set-up; of a circle left out they claim little.
    """
    time_s, circle = readings.state["time_s"], readings.groups["circle"]
    order = np.argsort(time_s, kind="stable")
    begins = 1 + np.flatnonzero(np.diff(circle[order]))
    if not 1 < len(begins) < MOST_CIRCLES:
        return []
    variable = step(time_s[order][begins].tolist())
    return list(varying((Learned(place, ALL, variable) for place in ("ball", "cup")), readings))


def by_mount_of(readings: Readings) -> list[Learned]:
    """Return what lets the ball's seat give way to the bar, or be out of round, otherwise with each mount of the cup.

    Of a ball that sits otherwise geometry takes nearly all, and then most of what is seen is how its seat differs. Each
    mount has a function of its own: one of several would say of a ball where it sits with the others. Of two mounts one
    is all but the other.
    """
    mounts = 1 + np.unique(readings.state["mount"])
    other = mounts if len(mounts) > 2 else mounts[1:]
    return list(varying((Learned("ball", ALL, by_mount(float(each))) for each in other), readings))


def _of_forms(readings: Readings) -> list[Learned]:
    """Return products that only describe forms, growth with warmth, and steps from circle to circle."""
    of_forms = (each for each in all_varying(readings, of_forms=True) if each.variable.times)
    return [*of_forms, *varying(grown_with_warmth(), readings), *by_circle(readings), *by_mount_of(readings)]


class Learnable:
    """Learned hypotheses whose variable varies in some readings.

    Parameters
    ----------
    readings : Readings
    learns : bool
        Whether they are looked at; if not, the simple ones tell only where known effects live.

    Attributes
    ----------
    simple : list of Learned
    products : list of Learned
        Further ones in which a known effect's form may be wrong.
    of_forms : list of Learned
        Others that describe how the form of an effect at the same port is wrong: functions of the angle a joint has
        turned since it reversed, growth with warmth, steps of ball and cup from circle to circle.
    """

    def __init__(self, readings: Readings, *, learns: bool) -> None:
        self._readings = readings
        self.simple = [each for each in all_varying(readings) if not _is_said_already(each, readings)]
        self.products = list(varying(products(), readings)) if learns else []
        self.of_forms = _of_forms(readings) if learns else []
        self._further: dict[str, Learned] = {}
        self._crossed: dict[str, Learned] = {}
        self._chosen: dict[Learned, float] = {}

    @property
    def further(self) -> dict[str, Learned]:
        """Those that are looked at where no simple one settles, by name; made when first asked for."""
        if not self._further:
            self._further = self._by_name(further_hypotheses())
        return self._further

    @property
    def crossed(self) -> dict[str, Learned]:
        """Those that are looked at last: every state at every place, and products of any two; made when first asked."""
        if not self._crossed:
            self._crossed = self._by_name(crossed_hypotheses())
        return self._crossed

    def _by_name(self, every: Iterable[Learned]) -> dict[str, Learned]:
        return {each.name: each for each in varying(every, self._readings) if not self._is_angle(each)}

    def _is_angle(self, learned: Learned) -> bool:
        """Check for a function of the platform's place if its position follows from the circle's angle."""
        return not learned.variable.needs.isdisjoint(PLACE) and self._are_circles_alike

    @cached_property
    def _are_circles_alike(self) -> bool:
        """Whether the platform's position in the x-y plane follows from the angle: one centre, radius and plane."""
        angle, position = self._readings.state["angle_rad"], self._readings.state["position_mm"][:, :2]
        waves = np.column_stack([np.ones_like(angle), np.cos(angle), np.sin(angle)])
        left = position - waves @ np.linalg.lstsq(waves, position, rcond=None)[0]
        return float(np.var(left)) < ALIKE * float(np.var(position))

    def is_further(self, hypothesis: Hypothesis) -> bool:
        """Check whether a hypothesis is one of those that are looked at where no simple one settles."""
        return hypothesis.name in self._further or self.is_crossed(hypothesis)

    def is_crossed(self, hypothesis: Hypothesis) -> bool:
        """Check whether a hypothesis is one of those that are looked at last."""
        return hypothesis.name in self._crossed

    @property
    def by_name(self) -> dict[str, Learned]:
        """All that were looked at, those that the readings propose among them."""
        known = {each.name: each for each in (*self.products, *self.simple, *self._chosen)}
        return self._further | self._crossed | known

    def log_prior(self, hypothesis: Learned) -> float:
        """Return the log of one over the number of its sort, and what the choice of its instants or period costs."""
        count = len(self.simple) + (len(self._further) if self.is_further(hypothesis) else 0)
        count += len(self._crossed) if self.is_crossed(hypothesis) else 0
        return self._chosen.get(hypothesis, 0.0) - float(np.log(max(count, 1)))

    def propose(self, proposed: Sequence[Proposal]) -> None:
        """Keep what the choice of hypotheses' instants or periods costs."""
        self._chosen |= {each.hypothesis: each.log_prior for each in proposed}

    def count_as(self, hypothesis: Learned, same: Learned) -> None:
        """Let a hypothesis stand for one that it was made of: its choice costs as much."""
        self._chosen[hypothesis] = self._chosen.get(same, 0.0)
        if self.is_further(same):
            self._further[hypothesis.name] = hypothesis
