"""What is calibrated, and taken as it is stated: fitted all the same where the readings contradict it.

A new model holds the length of the bar. Where it is some micrometres off, what is missing is no fault of the machine,
and no function of the machine's state says it: by geometry bent far beyond what machines have, a clean one was a gauge
that reads by the platform's yaw.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from hexdbb import _core
from hexdbb.effects.words import effect_clause
from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Trial
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.linear.sums import Sums
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import leaves_no_structure
from hexdbb.evidence.verdict.one_cause import left_without
from hexdbb.model import Model, Size, default_effects
from hexdbb.units import shown_factor, shown_unit

NEARLY = 0.9
"""Part of the evidence of the least causes from which a value that is off may say all of them, and is fitted to see: to
first order it came out at 0.94 to 0.99 of what it then had, of four bars 2 to 8 µm off."""

MOST_TRIED = 6
"""Sets of the same effects at fewer elements that are asked beside it: an effect at each of six elements alone. As many
others with the most evidence."""


@dataclass(frozen=True)
class Calibrated:
    """Effects whose values a new model holds.

    Attributes
    ----------
    names : tuple of str
        Of those that a model holds too; none where it fits them.
    model : Model
        The model with these fitted.
    """

    names: tuple[str, ...]
    model: Model

    @classmethod
    def of(cls, model: Model) -> Calibrated:
        """Return those of a model."""
        held = {name for name, is_free in default_effects(model.machine).items() if not is_free}
        named = zip(model.parameters(), model.free, strict=True)
        names = tuple(dict.fromkeys(each.effect for each, is_free in named if each.effect in held and not is_free))
        return cls(names, model.with_free(model.free | [each.effect in names for each in model.parameters()]))

    def is_off(self, search: Search, node: Node, *, is_sure: bool) -> bool:
        """Check whether readings say that a value is off: beside all that was found, or in place of some of it.

        Where causes are for sure, only the latter is asked: a bar 7 µm longer than stated, beside a drive that lags,
        was a guideway bowed by a tenth of a millimetre. Where they are not, and much is left, that counts as the noise:
        some of it looks like any value. A bar 3 µm shorter, beside a gauge read late, was six screws with one lead,
        which were not for sure and left nothing. And a value that is off lets a function say what another does.

        Parameters
        ----------
        search : Search
            Of the model that holds them.
        node : Node
            What was found.
        is_sure : bool
            Whether it is for sure.
        """
        if not is_sure:
            if self._is_seen(search, node.trial) or self._favours_another(search, node):
                return True
            if not leaves_no_structure(search, node):
                return False
        lacking = node.trial.log_evidence
        fewer = _with_fewer(search, node)
        return any(self._gain(search, each) > NEARLY * (lacking - each.log_evidence) for each in fewer)

    def _is_seen(self, search: Search, trial: Trial) -> bool:
        """Check that fitting these values beside a trial is worth more than what it leaves may look like."""
        return self._gain(search, trial) > search.criteria.detect_nats * max(trial.left, 1.0)

    def _favours_another(self, search: Search, node: Node) -> bool:
        """Check for another set of no more causes, beside which these values would be worth what it lacks, if anything.

        A leg that its motor warms had more evidence than heat of a screw by the place, and did not predict other
        circles, by a bar 10 µm shorter than stated.
        """
        others = [
            each
            for each in search.nodes
            if 0 < each.faults <= node.faults and each is not node and not each.trial.refused
        ]
        others.sort(key=lambda each: -each.trial.log_evidence)
        lacking = ((each.trial, node.trial.log_evidence - each.trial.log_evidence) for each in others[:MOST_TRIED])
        return any(
            self._gain(search, trial) > NEARLY * max(lacks, 0.0) and self._is_seen(search, trial)
            for trial, lacks in lacking
        )

    def _gain(self, search: Search, trial: Trial) -> float:
        """Return the evidence that fitting these values adds to a trial, to first order, with their priors."""
        engine, held = search.engine, search.trials.linear(trial)
        plain = engine.without_learned(trial.model)
        columns = [place for place, each in enumerate(plain.parameters()) if each.effect in self.names]
        jacobian = _core.predict(*engine.plain(trial.model), want_jacobian=True).jacobian[:, columns]
        fitted = held.wider(jacobian * plain.prior_sigma[columns] / engine.row_noise_mm[:, None])
        white = [Sums(each, engine.readings, ()).whole.own for each in (held, fitted)]
        return fitted.log_evidence - held.log_evidence + 0.5 * float(white[1] @ white[1] - white[0] @ white[0])

    def sentences(self, engine: Engine, model: Model) -> Iterator[str]:
        """Yield how far off each value is.

        Parameters
        ----------
        engine : Engine
            Of the model that fits them.
        model : Model
            The same with all that was found.
        """
        fitted = engine.linearised(model)
        own = fitted.linear.own
        sigma = dict(zip(fitted.free, np.sqrt(np.diag(np.linalg.inv(own.T @ own + np.eye(own.shape[1])))), strict=True))
        parameters = model.parameters()
        for name in self.names:
            sizes = []
            for place, each in enumerate(parameters):
                if each.effect == name and place in sigma:
                    factor = shown_factor(each.unit)
                    spread = float(sigma[place] * model.prior_sigma[place]) * factor
                    value = float(model.values[place]) * factor
                    sizes.append(Size(each.element, each.name, value, spread, shown_unit(each.unit)))
            yield f"{effect_clause(model.info(name), sizes)}: fitted here; hexdbb add {name} puts it into the model"


def _with_fewer(search: Search, node: Node) -> Iterator[Trial]:
    """Yield sets that lack some of a set's causes, the least first, and tried ones of its effects at fewer elements."""
    members = sorted(node.members, key=lambda each: left_without(search, node, each.hypothesis))
    for place in range(1, len(members)):
        with suppress(RunError):  # such a set has nothing to be compared with
            yield search.trials.of_fewer(members[place:], node.trial)
    effects, fewer = _effects(node), (each for each in search.nodes if 0 < each.faults < node.faults)
    tried = [each for each in fewer if each.is_known and _effects(each) <= effects]
    tried.sort(key=lambda each: -each.trial.log_evidence)
    yield from (each.trial for each in tried[:MOST_TRIED])


def _effects(node: Node) -> set[str]:
    return {each.effect for each in node.hypotheses if isinstance(each, Known)}
