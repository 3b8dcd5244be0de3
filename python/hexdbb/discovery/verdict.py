"""From candidates to a verdict: what must be shown before an effect is named.

With 20,000 readings everything is significant, so evidence alone never decides. Of the effect with the largest
evidence it is asked that it

- explains a substantial share of what is unexplained, the more so the more values it brings, or leaves only noise;
- predicts circles it was not fitted to as well as those it was: what stands in for the cause fits, but does not
  predict;
- if it does not do so alone, does so together with others, each of which takes a part.

Then, whether others explain the same.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from hexdbb.diagnosis import HeldOut, expected_error, held_out, refitter
from hexdbb.discovery.lack_of_fit import LackOfFit
from hexdbb.discovery.next_test import next_test
from hexdbb.discovery.result import Candidate, Discovery, Verdict
from hexdbb.discovery.search import Search, Trial
from hexdbb.discovery.trial import Base
from hexdbb.discovery.unexplained import unexplained_structure

SUBSTANTIAL = 0.5
"""Share of the unexplained that an effect must explain, where structure stays beside it."""
FEW_VALUES = 3
PER_VALUE = 0.03
MOST_ASKED = 0.95
SUBSTANTIAL_LEFT_OUT = 0.3
"""The same on readings left out of the fit."""
UNSEEN = 1.5
"""Readings left out of the fit may be missed by so much more than those in it."""
MOST_LEADERS = 3
"""So many effects are tried as the first of several."""
MOST_COMPANY = 4
"""So many effects are looked for beside one."""
LEAST_PART = 0.25
"""Share of what is left that each of several must explain."""
COMPLETE = 0.94
"""Share of the unexplained that several effects together must explain, where a little structure stays."""
STRONG = 10.0
"""Fall of BIC that counts as very strong evidence (Kass and Raftery 1995)."""
SIGNIFICANT_P = 1e-3
ALIKE = 10.0
"""Effects whose chi-squares differ by less explain the readings alike."""
MOST_FOLDS = 4
MORE = "something else is missing besides: look again once this effect is added"


def judge(search: Search, trials: Sequence[Trial]) -> Discovery:
    """Give the verdict.

    Parameters
    ----------
    search : Search
    trials : sequence of Trial
        The best candidates, the largest evidence first.
    """
    lack = search.lack
    best = trials[0] if trials and _is_evident(trials[0].candidate) else None
    if best is None or (not lack.is_significant and best.candidate.bic_drop < 3.0 * STRONG):
        return _outcome("unknown" if lack.is_significant else "none", search.base, lack, trials, None)
    search.progress("confirming on readings left out of the fit")
    checked = _confirm(search.base, best.candidate)
    named = best if _accounts_for(search.base, best, checked) else None
    if named is None or named.lack.is_significant:
        leaders = [trial for trial in trials[:MOST_LEADERS] if _is_evident(trial.candidate) and _takes_part(trial)]
        named = _in_company(search, leaders, named) or named
    if named is None:
        return _outcome("unknown" if lack.is_significant else "none", search.base, lack, trials, checked)
    trials = (named, *(trial for trial in trials if trial.candidate.effect != named.candidate.effect))
    alike = [
        trial.candidate
        for trial in trials[1:]
        if named.candidate.effect == best.candidate.effect and _explains_alike(trial.candidate, best.candidate)
    ]
    if not alike:
        return _outcome("effect", search.base, lack, trials, checked)
    search.progress("looking for a circle that tells them apart")
    return replace(
        _outcome("ambiguous", search.base, lack, trials, checked),
        ambiguous_with=tuple(each.effect for each in alike),
        next_test=next_test(search.base, named.candidate, alike[0]),
    )


def _is_evident(candidate: Candidate) -> bool:
    return candidate.bic_drop > STRONG and candidate.p_value < SIGNIFICANT_P


def _takes_part(trial: Trial) -> bool:
    return trial.candidate.share >= LEAST_PART


def _explains_alike(other: Candidate, best: Candidate) -> bool:
    return best.chi_square_drop - other.chi_square_drop < ALIKE and _is_evident(other)


def _accounts_for(base: Base, trial: Trial, checked: HeldOut | None) -> bool:
    """Whether an effect explains enough where it was fitted, and predicts where it was not."""
    candidate = trial.candidate
    asked = min(SUBSTANTIAL + PER_VALUE * max(len(candidate.values) - FEW_VALUES, 0), MOST_ASKED)
    enough = candidate.share >= asked or not trial.lack.is_significant
    return enough and _helps(trial, checked) and _predicts(base, trial, checked)


def _helps(trial: Trial, checked: HeldOut | None) -> bool:
    return checked is None or checked.share(trial.lack.noise_um) >= SUBSTANTIAL_LEFT_OUT * trial.candidate.share


def _predicts(base: Base, trial: Trial, checked: HeldOut | None) -> bool:
    """Whether readings left out are missed by no more than those fitted, but for what the rest cannot tell of them."""
    level_um = max(trial.lack.rms_um, trial.lack.noise_um)
    if checked is None or checked.after_um <= UNSEEN * level_um:
        return True
    expected = expected_error(base.samples, trial.candidate.model, level_um, MOST_FOLDS)
    return expected is not None and not expected.extrapolates and checked.after_um <= UNSEEN * expected.expected_um


def _in_company(search: Search, leaders: Sequence[Trial], alone: Trial | None) -> Trial | None:
    """Give the effect that with others beside it leaves only noise: two faults of one size each explain half.

    Of the `leaders` that find such company it is the one whose company explains most with fewest values, or the one
    that was convincing `alone` where it is in that company. Elements that stood in for the others are left out of it.
    """
    found = [(leader, last) for leader in leaders if (last := _last_beside(search, leader)) is not None]
    for leader, last in sorted(found, key=lambda each: -_worth(search.base, each[1])):
        is_in_it = alone is not None and alone.candidate.effect in _company(search.base, last)
        needed = search.without_needless(alone if alone is not None and is_in_it else leader, last)
        if needed is None:
            continue
        search.progress("confirming them on readings left out of the fit")
        checked = _confirm(search.base, last.candidate)
        return needed if _helps(last, checked) and _predicts(search.base, last, checked) else None
    return None


def _last_beside(search: Search, leader: Trial) -> Trial | None:
    """Add effects beside one, each of which explains a part of what is left, until only noise is; give the last."""
    last, left = leader, 1.0 - leader.candidate.share
    for _ in range(MOST_COMPANY):
        search.progress(f"looking for another effect beside {leader.candidate.choice}")
        search = search.beside(last.candidate)
        ranked, tried = search.ranked()
        found = search.trials(ranked[:2], tried)
        if not found or not _is_evident(found[0].candidate) or not _takes_part(found[0]):
            return None
        last = found[0]
        left *= 1.0 - last.candidate.share
        if left < 1.0 - COMPLETE or not last.lack.is_significant:
            return last
    return None


def _company(base: Base, last: Trial) -> set[str]:
    """Effects that the model has by now and the base has not."""
    parameters, had = last.candidate.model.parameters(), base.model.parameters()
    free = {each for each, is_free in zip(had, base.model.free, strict=True) if is_free}
    return {
        each.effect
        for each, is_free in zip(parameters, last.candidate.model.free, strict=True)
        if is_free and each not in free
    }


def _worth(base: Base, last: Trial) -> float:
    """Fall of BIC from the base to all effects together."""
    squared = float(last.result.residual_mm @ last.result.residual_mm) / base.noise.sigma_mm**2
    values = int(last.candidate.model.free.sum() - base.model.free.sum())
    return base.squared - squared - values * float(np.log(base.readings))


def _confirm(base: Base, candidate: Candidate) -> HeldOut | None:
    fit = refitter(base.noise)
    before, after = (base.model, fit), (candidate.model, fit)
    by: Literal["circle", "sweep"] = "circle" if _told_by_others(base, candidate) else "sweep"
    return held_out(base.samples, before, after, by, MOST_FOLDS)


def _told_by_others(base: Base, candidate: Candidate) -> bool:
    """Whether some circles tell what matters on others: of a set-up without its circles, of few circles, nothing.

    What the candidate takes away from that is no excuse: with enough values that no circle tells anything is explained.
    """
    if base.model.info(candidate.effect).element_kind == "mount":
        return False
    expected = expected_error(base.samples, base.model, base.noise.sigma_mm * 1e3, MOST_FOLDS)
    return expected is not None and not expected.extrapolates


def _outcome(
    verdict: Verdict, base: Base, lack: LackOfFit, trials: Sequence[Trial], checked: HeldOut | None
) -> Discovery:
    named = trials[0] if verdict in ("effect", "ambiguous") else None
    left, residual, model = lack, base.residual_mm, base.model
    if named is not None:
        left, residual, model = named.lack, named.result.residual_mm, named.candidate.model
    structure = unexplained_structure(base.samples, model, residual, base.noise) if left.is_significant else ()
    return Discovery(
        verdict=verdict,
        lack_of_fit=lack,
        rms_before_um=lack.rms_um,
        rms_after_um=lack.rms_um if named is None else named.candidate.rms_after_um,
        heldout_before_um=None if checked is None else checked.before_um,
        heldout_after_um=None if checked is None else checked.after_um,
        candidates=tuple(trial.candidate for trial in trials),
        ambiguous_with=(),
        next_test=None,
        structure=structure,
        remarks=(MORE,) if named is not None and left.is_significant else (),
    )
