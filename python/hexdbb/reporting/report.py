"""What a report shows, put together from the analysis of the packages below."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from hexdbb.comparison import Comparison, compare
from hexdbb.contributions import Contributions, rank_contributions
from hexdbb.diagnosis import Sufficiency, assess_sufficiency, diagnose, fit_mounts
from hexdbb.machine import Tolerance
from hexdbb.model import Model
from hexdbb.reporting.json_form import JudgedJson, ReportJson
from hexdbb.reporting.judgement import Judged, judge
from hexdbb.reporting.next_steps import NextStep, next_steps
from hexdbb.reporting.verdict import verdict
from hexdbb.samples import Samples
from hexdbb.threads import one_thread

Progress = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class Report:
    """All that a report shows.

    Attributes
    ----------
    verdict : str
        What the test found, in one sentence.
    samples : Samples
    model : Model
        With the set-ups of the samples.
    comparison : Comparison
    contributions : Contributions
    sufficiency : Sufficiency
        Whether anything that matters is missing from the model.
    judged : tuple of Judged
        Quantities that have a tolerance; empty where none has.
    rank, values : int or None
        Combinations of the machine's own free values that these readings determine, and number of these values; None
        where the model has no free value.
    unidentifiable : tuple of str
        What the readings do not determine, in sentences.
    next_steps : tuple of NextStep
        What to measure or do next, the first first.
    """

    verdict: str
    samples: Samples = field(repr=False)
    model: Model = field(repr=False)
    comparison: Comparison = field(repr=False)
    contributions: Contributions = field(repr=False)
    sufficiency: Sufficiency
    judged: tuple[Judged, ...]
    rank: int | None
    values: int | None
    unidentifiable: tuple[str, ...]
    next_steps: tuple[NextStep, ...]

    def to_json(self) -> dict[str, object]:
        """Return what ``hexdbb report --json`` prints."""
        return ReportJson(
            verdict=self.verdict,
            passes=None if not self.judged else all(each.passes for each in self.judged),
            judged=tuple(
                JudgedJson(each.record_name, each.symbol, each.limit_um, each.worst_um, each.passes, each.where)
                for each in self.judged
            ),
            contributions=self.contributions.json_form().records,
            unidentifiable=self.unidentifiable,
            next_steps=tuple(each.sentence for each in self.next_steps),
        ).to_json()


@one_thread
def make_report(
    samples: Samples,
    model: Model,
    *,
    tolerance: Tolerance | None = None,
    find_cause: bool = True,
    progress: Progress = lambda _: None,
) -> Report:
    """Analyse records for a report.

    Parameters
    ----------
    samples : Samples
        Of one record, or of several that are compared.
    model : Model
        It stays as it is, but for set-ups that it does not know, which are fitted.
    tolerance : Tolerance, optional
        What circles are judged by; that of the first record's machine file where not given.
    find_cause : bool
        Whether the likely cause of a residual beyond noise is looked for, two or three seconds for 20,000 readings.
    progress : callable
        Called with what is being done.

    Raises
    ------
    InputError
        Records of another machine or one of them twice, or a sample that the machine cannot reach.
    """
    progress("comparing")
    known, _ = fit_mounts(samples, model)
    comparison = compare(samples, known, find_cause=find_cause)
    progress("what the readings determine")
    found = diagnose(samples, known, check_held_out=False) if known.free.any() else None
    sufficiency = assess_sufficiency(samples, known, comparison.residual_mm)
    progress("contributions")
    covariance = np.zeros((len(known.values),) * 2) if found is None else found.covariance
    contributions = rank_contributions(samples, known, circles=comparison.circles, covariance=covariance)
    judged = judge(comparison.circles, tolerance or samples.records[0].machine.tolerance)
    rank, values = (None, None) if found is None else (found.rank, found.machine_values)
    return Report(
        verdict=verdict(comparison, contributions, sufficiency, judged),
        samples=samples,
        model=known,
        comparison=comparison,
        contributions=contributions,
        sufficiency=sufficiency,
        judged=judged,
        rank=rank,
        values=values,
        unidentifiable=() if found is None else found.unidentifiable,
        next_steps=next_steps(samples, known, comparison, sufficiency, rank),
    )
