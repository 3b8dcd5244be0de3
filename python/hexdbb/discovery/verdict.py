"""From candidates to a verdict: what must be shown before an effect is named.

With 20,000 readings everything is significant, so evidence alone never decides. Of the effect with the largest
evidence it is asked that it

- explains a substantial share of what is unexplained, the more so the more values it brings, or leaves only noise;
- predicts circles it was not fitted to as well as those it was: what stands in for the cause fits, but does not
  predict;
- if it does not do so alone, does so together with one other effect.

Then, whether others explain the same.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

from hexdbb.diagnosis import HeldOut, foretold, held_out, refitter
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
COMPLETE = 0.97
"""Share of the unexplained that two effects together must explain, where a little structure stays."""
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
    if named is None or (named.lack.is_significant and len(named.candidate.elements) > 1):
        named = _in_company(search, best, checked) or named
    if named is None:
        return _outcome("unknown" if lack.is_significant else "none", search.base, lack, trials, checked)
    trials = (named, *trials[1:])
    alike = [trial.candidate for trial in trials[1:] if _explains_alike(trial.candidate, named.candidate)]
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
    expected = foretold(base.records, trial.candidate.model, level_um, MOST_FOLDS)
    return expected is not None and checked.after_um <= UNSEEN * expected.expected_um


def _in_company(search: Search, best: Trial, checked: HeldOut | None) -> Trial | None:
    """Give the best effect, where a second one beside it leaves only noise: two faults of one size each explain half.

    Elements that stood in for the second effect are left out.
    """
    if not _helps(best, checked):
        return None
    search.progress("looking for a second effect beside it")
    beside = search.beside(best.candidate)
    ranked, tried = beside.ranked()
    for second in beside.trials(ranked[:1], tried):
        together = (search.base.squared - beside.base.squared) / search.base.excess
        together += second.candidate.share * beside.base.excess / search.base.excess
        if not _is_evident(second.candidate) or (second.lack.is_significant and together < COMPLETE):
            return None
        search.progress("confirming both on readings left out of the fit")
        both = _confirm(search.base, second.candidate)
        if _helps(second, both) and _predicts(search.base, second, both):
            return search.without_needless(best, second)
    return None


def _confirm(base: Base, candidate: Candidate) -> HeldOut | None:
    fit = refitter(base.noise)
    before, after = (base.model, fit), (candidate.model, fit)
    by: Literal["circle", "sweep"] = "circle" if _told_by_others(base, candidate) else "sweep"
    return held_out(base.measured, before, after, by, MOST_FOLDS)


def _told_by_others(base: Base, candidate: Candidate) -> bool:
    """Whether some circles tell what matters on others: of a set-up without its circles, of few circles, nothing."""
    if base.model.info(candidate.effect).element_kind == "mount":
        return False
    expected = foretold(base.records, candidate.model, base.noise.sigma_mm * 1e3, MOST_FOLDS)
    return expected is not None and not expected.extrapolates


def _outcome(
    verdict: Verdict, base: Base, lack: LackOfFit, trials: Sequence[Trial], checked: HeldOut | None
) -> Discovery:
    named = trials[0] if verdict in ("effect", "ambiguous") else None
    left, residual, model = lack, base.residual_mm, base.model
    if named is not None:
        left, residual, model = named.lack, named.result.residual_mm, named.candidate.model
    structure = unexplained_structure(base.records, model, residual, base.noise) if left.is_significant else ()
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
