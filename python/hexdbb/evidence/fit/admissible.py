"""What speaks against a hypothesis: its values, its form, what it does not predict."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from hexdbb.evidence.criteria import Criteria
from hexdbb.evidence.fit.formula import left_by_formulas
from hexdbb.evidence.fit.heldout import HeldOut, contradiction, heldout, is_its_formula
from hexdbb.evidence.fit.trial import Trial
from hexdbb.evidence.fit.trials import Trials
from hexdbb.evidence.linear.readings import ARC
from hexdbb.evidence.linear.screen import Known

WORDS = {"circle": "other circles", "feed": "the other feed", "direction": "the other direction", "lap": "other laps"}


@dataclass(frozen=True)
class Checked:
    """Prediction by grouping, the share explained where fitted, and reasons of refusal."""

    heldout: Mapping[str, HeldOut]
    share: float
    reasons: tuple[str, ...]
    excused_from: tuple[str, ...] = ()
    """What would be reasons, were it not put down to its form."""
    claimed: tuple[str, ...] = ()
    """Groupings that the hypotheses claim to predict."""
    missed: float = 0.0
    """Error of the grouping predicted worst, beyond what the fit expects of it, over the RMS explained where fitted."""
    missed_at_least: float = 0.0
    """The same where of several causes each predicts by its formula, or with its form, whichever errs less."""
    of_geometry: tuple[str, ...] = ()
    """Those of the reasons and excuses that geometry has too: it does not predict the same groups alone."""

    @property
    def excused(self) -> bool:
        """Whether something that is not predicted was put down to its form."""
        return bool(self.excused_from)


def check(trial: Trial, base: Trial, trials: Trials, criteria: Criteria) -> Checked:
    """Check a trial against the model without its hypotheses.

    A grouping refuses it where the share explained falls by more than `Criteria.heldout_share_min` and the error is
    larger than the fit to the other groups expects of itself (`Criteria.heldout_ratio`): that few circles determine a
    value badly is no reason. Nor is it one that a form not quite right, whose remainder geometry bends after, does not
    predict circles that geometry alone does not predict either. Free functions of time alone claim nothing of a time
    that was left out, and every group lies in a time of its own; what stands beside them claims what it claims alone.
    What lies between other readings they do claim: noise that changes slowly is no function. What predicts no grouping
    at all is refused however little it adds to the noise.
    """
    predicted = heldout(trial, base, trials)
    excess = base.left - 1.0
    share = (base.left - trial.left) / excess if excess > 0.0 else 0.0
    reasons: list[str] = []
    excused: list[str] = []
    of_geometry: list[str] = []
    if trial.is_of_time:
        return Checked(predicted, share, _not_between(predicted, share, criteria), claimed=(ARC,))
    is_formula = _is_one_effect(trial) and is_its_formula(trial, base, trials)
    by_formulas = left_by_formulas(trial.forms, trials.linear(trial)) if is_formula else base.left
    for grouping, held in predicted.items():
        if grouping == ARC:
            continue
        expected = held.expected * max(trial.left, 1.0) ** 0.5
        if held.share >= criteria.heldout_share_min * share or held.after <= criteria.heldout_ratio * expected:
            continue
        extrapolates = held.before > criteria.extrapolates * base.left**0.5
        is_excused = extrapolates and _bends_geometry(trial, share, criteria)
        is_excused |= is_formula and errs_by_chance(held, trial, base, by_formulas, criteria)
        words = f"does not predict {WORDS[grouping]}"
        (excused if is_excused else reasons).append(words)
        if extrapolates:
            of_geometry.append(words)
    claimed = [held for grouping, held in predicted.items() if grouping != ARC]
    if claimed and not (
        reasons or excused or any(held.share >= criteria.heldout_share_min * share for held in claimed)
    ):
        reasons.append("predicts nothing that was left out")
    missed = at_least = 0.0
    for grouping, held in predicted.items():
        if grouping != ARC:
            errors = _missed(grouping, held, trial, base, trials, criteria)
            missed, at_least = max(missed, errors[0]), max(at_least, errors[1])
    return Checked(
        predicted, share, tuple(reasons), tuple(excused), tuple(predicted), missed, at_least, tuple(of_geometry)
    )


def _missed(
    grouping: str, held: HeldOut, trial: Trial, base: Trial, trials: Trials, criteria: Criteria
) -> tuple[float, float]:
    """Return `missed_of` for the error as fitted and for the least error.

    Where several causes contradict the readings that were kept, their expected error is no excuse: only the noise is
    subtracted. A single effect is exempt, since a form 20 % off its formula contradicts other circles as well.
    """
    errors = (held.as_fitted, held.after)
    missed, at_least = (missed_of(held, error, trial, base, criteria) for error in errors)
    beyond = [_over_explained(error**2 - max(trial.left, 1.0), trial, base) for error in errors]
    is_large = len(trial.members) > 1 and beyond[0] > criteria.missed_sure
    if is_large and contradiction(trial, trials, grouping) >= criteria.by_chance:
        return beyond[0], beyond[1]
    return missed, at_least


def missed_of(held: HeldOut, error: float, trial: Trial, base: Trial, criteria: Criteria) -> float:
    """Return an error of a grouping beyond what is expected of it, over what is explained where fitted.

    Where geometry leads away, what is expected beyond the noise comes of few directions that the other groups hardly
    determine, and is by chance larger: by up to `Criteria.heldout_ratio`.
    """
    noise = min(held.expected, 1.0) ** 2
    larger = criteria.heldout_ratio**2 if leads_away(held, base, criteria) else 1.0
    expected = noise + larger * (held.expected**2 - noise)
    return _over_explained(error**2 - expected * max(trial.left, 1.0), trial, base)


def _over_explained(beyond: float, trial: Trial, base: Trial) -> float:
    return float(np.sqrt(max(beyond, 0.0) / max(base.left - trial.left, 1e-9)))


def leads_away(held: HeldOut, base: Trial, criteria: Criteria) -> bool:
    """Check whether the readings left in hold geometry so badly that what is left out says nothing."""
    return bool(held.before > criteria.leads_away * base.left**0.5)


def _is_one_effect(trial: Trial) -> bool:
    return len(trial.members) == 1 and isinstance(trial.members[0].hypothesis, Known)


def errs_by_chance(held: HeldOut, trial: Trial, base: Trial, by_formulas: float, criteria: Criteria) -> bool:
    """Check whether the error of what was left out is what chance and geometry make of what the formulas leave.

    A small part of a form that they leave is carried by geometry to circles that the others hardly hold, as what is
    missing is: by its error there for each noise variance that it leaves where fitted.

    Parameters
    ----------
    held : HeldOut
    trial, base : Trial
        The set, and the model without it.
    by_formulas : float
        What the set leaves by its formulas, in noise variances.
    criteria : Criteria
    """
    carried = held.before**2 / base.left * max(by_formulas - 1.0, 0.0)
    expected = held.expected**2 * max(trial.left, 1.0)
    return bool(held.after**2 <= criteria.by_chance * (expected + carried))


def _not_between(predicted: Mapping[str, HeldOut], share: float, criteria: Criteria) -> tuple[str, ...]:
    """Return why functions of time are refused: they must predict arcs left out as well as a cause has to explain."""
    between = predicted.get(ARC)
    is_refuted = between is not None and between.share < criteria.explained_min * min(share, 1.0)
    return ("does not predict the times between",) if is_refuted else ()


def _bends_geometry(trial: Trial, share: float, criteria: Criteria) -> bool:
    """Check for an effect that explains nearly all, but whose form is not quite right.

    What is left shows it, or the evidence for functions beside the effect. One that explains a part only may stand in
    for another cause.
    """
    has_form = any(form is not None and form.fraction > 0.0 for form in trial.forms)
    return share > criteria.form_explains and (has_form or trial.left > criteria.leaves_structure)
