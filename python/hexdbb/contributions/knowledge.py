"""How well the curve of each group is known, and which groups are known only together.

The values of a model have the covariance C that their fit leaves them, prior included. A group g with Jacobian J_g
(centre and radius removed, `curves`) has a curve that is uncertain by the mean square

    E_gg = trace(J_g C_gg J_g') / n,   and two groups by   E_gh = trace(J_g C_gh J_h') / n.

Two groups whose curves the readings cannot separate, as guideways and home positions, are each uncertain by as much as
the prior allows, and E_gh is as large and negative: their sum is known. Groups that the readings do not determine are
therefore joined, the most strongly opposed pair first, until every combination is determined or has no opposite left.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.contributions.groups import Group
from hexdbb.identifiability import KNOWN_PART

Floats = NDArray[np.float64]

OPPOSED = -0.3
"""Correlation of two groups' uncertainties, at or below which they are confounded: the sum is then known better than
either by a tenth at least. Groups that merely share a few readings stay within a few hundredths of zero."""


@dataclass(frozen=True, eq=False)
class Combination:
    """Groups that are known together, in µm.

    Attributes
    ----------
    members : tuple of int
        Places of the groups.
    sigma_um : float
        Root mean square uncertainty of their common curve.
    prior_um : float
        The same before any reading.
    """

    members: tuple[int, ...]
    sigma_um: float
    prior_um: float

    @property
    def is_known(self) -> bool:
        """Whether the readings determine it, by the measure that `diagnose` applies to single values."""
        return self.sigma_um <= KNOWN_PART * self.prior_um


@dataclass(frozen=True, eq=False)
class Knowledge:
    """Mean square uncertainties of groups' curves: `after` a fit and `before` it, shape (groups, groups), mm²."""

    after: Floats
    before: Floats

    @classmethod
    def of(cls, groups: Sequence[Group], jacobian: Floats, covariance: Floats, prior_sigma: Floats) -> Knowledge:
        """Compute them from the centred Jacobian of all values, shape (n, size)."""
        inner = jacobian.T @ jacobian / len(jacobian)
        after = [[_shared(inner, covariance, one, other) for other in groups] for one in groups]
        prior = np.diag(prior_sigma**2)
        before = [[_shared(inner, prior, one, other) for other in groups] for one in groups]
        return cls(np.array(after), np.array(before))

    def combination(self, members: Sequence[int]) -> Combination:
        """Return how well some groups are known together."""
        at = np.ix_(members, members)
        after, before = float(self.after[at].sum()), float(self.before[at].sum())
        return Combination(tuple(members), 1e3 * max(after, 0.0) ** 0.5, 1e3 * max(before, 0.0) ** 0.5)

    def opposed(self, one: int) -> tuple[int, ...]:
        """Return the groups that are confounded with one, the most strongly opposed first."""
        opposition = {other: self._correlation((one,), (other,)) for other in range(len(self.after)) if other != one}
        return tuple(sorted((each for each in opposition if opposition[each] <= OPPOSED), key=opposition.__getitem__))

    def joined(self, members: Sequence[int]) -> list[Combination]:
        """Join groups that are known only together.

        Parameters
        ----------
        members : sequence of int
            The groups that may be joined.
        """
        found: list[tuple[int, ...]] = [(each,) for each in members]
        while True:
            unknown = [each for each in found if not self.combination(each).is_known]
            pairs = [(self._correlation(one, other), one, other) for one in unknown for other in found if other != one]
            least = min(pairs, default=None)
            if least is None or least[0] > OPPOSED:
                return [self.combination(each) for each in found]
            _, one, other = least
            found = [each for each in found if each not in (one, other)] + [tuple(sorted(one + other))]

    def _correlation(self, one: Sequence[int], other: Sequence[int]) -> float:
        def total(first: Sequence[int], second: Sequence[int]) -> float:
            return float(self.after[np.ix_(first, second)].sum())

        own = total(one, one) * total(other, other)
        return total(one, other) / own**0.5 if own > 0.0 else 0.0


def _shared(inner: Floats, covariance: Floats, one: Group, other: Group) -> float:
    """Return trace(J_g C_gh J_h') / n from J'J / n."""
    block = covariance[np.ix_(one.columns, other.columns)]
    return float(np.sum(inner[np.ix_(one.columns, other.columns)] * block))
