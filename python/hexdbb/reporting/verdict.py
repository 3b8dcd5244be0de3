"""The verdict of a report, in one sentence: how far off the circles are, what makes most of it, is anything missing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hexdbb.comparison import Comparison
from hexdbb.contributions import Contribution, Contributions, RecordContributions
from hexdbb.diagnosis import Sufficiency
from hexdbb.reporting.judgement import Judged
from hexdbb.samples.unmeasured import not_measured_sentences

MOST_NAMED = 3
"""Parts of a combined contribution that are named: the sentence remains one."""


def verdict(
    comparison: Comparison, contributions: Contributions, sufficiency: Sufficiency, judged: Sequence[Judged]
) -> str:
    """Return the verdict; it speaks of the last record where there are several, and compares it with the first."""
    return "; ".join(_clauses(comparison, contributions.records, sufficiency, judged)) + "."


def _clauses(
    comparison: Comparison, tables: Sequence[RecordContributions], sufficiency: Sufficiency, judged: Sequence[Judged]
) -> Iterator[str]:
    last = tables[-1].record_name
    own = [each for each in judged if each.record_name == last]
    if own:
        yield _judgement(own)
    yield _size(comparison, tables)
    rows = next((table.rows for table in reversed(tables) if table.rows), ())
    if rows:
        yield _largest(rows[0])
    if comparison.cause is not None:
        yield comparison.cause.sentence
    elif sufficiency.is_sufficient:
        yield f"the model explains all but {sufficiency.lack_of_fit.rms_um:.2f} µm RMS, nothing that matters is missing"
    else:
        yield f"something is missing from the model: {sufficiency.sentence}"
    yield from not_measured_sentences(comparison.samples.records)


def _judgement(judged: Sequence[Judged]) -> str:
    worst = [each for each in judged if each.passes is False]
    if worst:
        said = ", ".join(f"{each.symbol} {each.worst_um:.1f} µm against {each.limit_um:g} µm" for each in worst)
        return f"Fails its tolerance: {said}"
    unknown = [each for each in judged if each.passes is None]
    if unknown:
        return f"Not judged: {', '.join(each.symbol for each in unknown)} cannot be evaluated"
    return "Passes its tolerances: " + ", ".join(f"{each.symbol} {each.worst_um:.1f} µm" for each in judged)


def _size(comparison: Comparison, tables: Sequence[RecordContributions]) -> str:
    first, last = comparison.radial[0], comparison.radial[-1]
    if last.rms_mm is None or last.peak_to_valley_mm is None:
        return f"residual {1e3 * comparison.rms_mm:.2f} µm RMS on arcs that are no full circle"
    now = f"{1e3 * last.peak_to_valley_mm:.1f} µm peak to valley (circle {last.worst_circle})"
    if len(tables) > 1 and first.rms_mm is not None:
        return f"radial error {1e3 * first.rms_mm:.2f} µm -> {1e3 * last.rms_mm:.2f} µm RMS, now {now}"
    return f"the circles are off by {now}, {1e3 * last.rms_mm:.2f} µm RMS"


def _largest(row: Contribution) -> str:
    names = [part.label for part in sorted(row.parts, key=lambda part: -part.circular_deviation_um)]
    more = f" and {len(names) - MOST_NAMED} more" if len(names) > MOST_NAMED else ""
    together = " together" if len(names) > 1 else ""
    would = "would make" if len(names) > 1 else "alone would make"
    return f"{', '.join(names[:MOST_NAMED])}{more}{together} {would} {row.percent:.0f} % of the circular deviation"
