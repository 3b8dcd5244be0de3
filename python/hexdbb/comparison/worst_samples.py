"""The samples with the largest residuals, and the circumstances over-represented among them.

The residual is averaged over arcs of ten degrees of each capture first, so that single noisy readings do not count. The
worst arcs, those at least half as bad as the worst of all and at most a tenth of the samples, are compared with all
samples: a circumstance that most of the worst have and few of all marks where the residual is large. It need not be the
cause: on a circle all slider positions go together, so a range of one slider goes with those of the others and with the
angle. Hence each further circumstance must be over-represented among the samples that have the ones before it too;
otherwise it only repeats them and is left out. Where the likely cause of the residual is known, so is what goes with it
at other elements, and is left out too (`bystanders.py`). Ranges (angle, position, time) are the shortest that hold
`MOST` of the worst.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hexdbb.comparison.bystanders import goes_along, is_elsewhere
from hexdbb.comparison.circles import DIRECTION_NAMES, SECONDS_PER_MINUTE
from hexdbb.comparison.iso230 import FloatArray
from hexdbb.comparison.quantities import UM_PER_MM
from hexdbb.files.results import JsonPart, Share
from hexdbb.predictors import record_names
from hexdbb.predictors.variable import SLIDERS, TRAVEL_DIRECTION
from hexdbb.samples import Samples
from hexdbb.samples.distinct import distinct_rows

if TYPE_CHECKING:
    from hexdbb.discovery import LikelyCause

ARC_DEG = 10.0
"""Width of an arc, as of the worst arcs listed."""
WORST_PART = 0.1
"""Largest part of the samples called the worst: enough to share something, few enough to differ from the others."""
AS_BAD = 0.5
"""Residual of an arc, as part of the worst arc's, above which it can be among the worst."""
MOST = 0.7
"""Part of the worst samples that must have a circumstance ..."""
TIMES_OVER = 1.5
"""... and how many times more often they must have it than all samples: of white noise none does (tests)."""
NEAR_REVERSAL_S = 1.0
"""Time after a reversal that counts as near it: longer than a reversal spike, shorter than a slow circle's quarter."""
ALIKE = 0.05
"""Difference of the ratio in all / in worst below which the earlier of two circumstances is named: what was commanded
(direction, feed, circle, angle) comes before the sliders' positions, which follow from it."""
MOST_NAMED = 6
"""Largest number of circumstances named."""

Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Circumstance(JsonPart):
    """A circumstance that is over-represented among the worst samples."""

    what: str
    """The circumstance in words."""
    in_worst: Share
    """Part of the worst samples that have it."""
    in_all: Share
    """Part of all samples that have it."""
    rms_with_um: float | None
    """Root mean square residual of all samples that have it."""
    rms_without_um: float | None
    """Root mean square residual of the others; null where there are none."""

    @property
    def sentence(self) -> str:
        """The circumstance with its parts and residuals, in words."""
        return (
            f"{100.0 * self.in_worst:.0f} % of them, {100.0 * self.in_all:.0f} % of all: {self.what}"
            f" ({_shown(self.rms_with_um)} RMS with it, {_shown(self.rms_without_um)} without)"
        )


@dataclass(frozen=True)
class WorstSamples:
    """The worst samples: their number and residual, and what is over-represented among them, most first.

    Attributes
    ----------
    samples : int
    rms_um, rms_elsewhere_um : float
        Residual of the worst samples, and of the others (None where there are none).
    common : tuple of Circumstance
    bystanders : tuple of str
        Elements left out of `common`: what they have in common among the worst only goes with the likely cause.
    """

    samples: int
    rms_um: float
    rms_elsewhere_um: float | None
    common: tuple[Circumstance, ...]
    bystanders: tuple[str, ...] = ()

    @property
    def sentences(self) -> list[str]:
        """Number and residual, and each circumstance, in words."""
        others = _shown(self.rms_elsewhere_um)
        first = f"{self.samples} with a residual of {self.rms_um:.2f} µm RMS, the others {others}"
        if not self.common:
            beside = (
                f" beside what goes with the likely cause ({', '.join(self.bystanders)})" if self.bystanders else ""
            )
            return [f"{first}; no circumstance is over-represented among them{beside}"]
        heading = f"{first}; over-represented among them (not always the cause):"
        return [heading, *(each.sentence for each in self.common)]


def worst_samples(
    samples: Samples, residual_mm: FloatArray, cause: LikelyCause | None = None, noise_mm: float = 0.0
) -> WorstSamples:
    """Find the samples with the largest residuals and the circumstances over-represented among them.

    Parameters
    ----------
    samples : Samples
    residual_mm : (n,) array
        Measured minus predicted reading of each sample.
    cause : LikelyCause, optional
        Of the residual.
    noise_mm : float
        Standard deviation of one reading; 0 where it is not known.
    """
    residual_um = UM_PER_MM * residual_mm
    worst = _worst(samples, residual_um)
    rated, bystanders = [], []
    for subject, what, has in _circumstances(samples, worst):
        each = _rated(what, has, worst, residual_um)
        if not _over(each.in_worst, each.in_all):
            continue
        if cause and is_elsewhere(subject, cause) and goes_along(has, residual_mm, cause, noise_mm):
            bystanders.append(subject)
        else:
            rated.append((each, has))
    rated.sort(key=lambda each: round(each[0].in_all / each[0].in_worst / ALIKE))
    common: list[Circumstance] = []
    so_far = np.ones(len(worst), bool)
    for circumstance, has in rated:
        if _over(float(has[worst & so_far].mean()), float(has[so_far].mean())):
            common.append(circumstance)
            so_far &= has
    rms_um, elsewhere_um = _rms(residual_um[worst]), _rms(residual_um[~worst])
    assert rms_um is not None  # one arc at least
    named = tuple(dict.fromkeys(bystanders))
    return WorstSamples(int(worst.sum()), rms_um, elsewhere_um, tuple(common[:MOST_NAMED]), named)


def _over(in_worst: float, in_all: float) -> bool:
    return in_worst >= MOST and in_worst >= TIMES_OVER * in_all


def _worst(samples: Samples, residual_um: FloatArray) -> Mask:
    """Return the samples of the arcs with the largest root mean square: `AS_BAD` as the worst, up to `WORST_PART`."""
    arc = np.floor(_angle_deg(samples) / ARC_DEG + 1e-9).astype(np.int64)
    arc_of = distinct_rows(samples["record"], samples["sweep"], samples["lap"], arc)[1]
    size = np.bincount(arc_of)
    squared = np.bincount(arc_of, residual_um**2) / size
    order = np.argsort(-squared, kind="stable")
    as_bad = int(np.sum(squared >= AS_BAD**2 * squared[order[0]]))
    most = int(np.searchsorted(np.cumsum(size[order]), WORST_PART * len(arc_of), side="right"))
    return np.isin(arc_of, order[: max(min(as_bad, most), 1)])


def _circumstances(samples: Samples, worst: Mask) -> Iterator[tuple[str, str, Mask]]:
    """Yield what samples may have in common: the element it belongs to, if any, words, and which samples have it."""
    for direction, name in DIRECTION_NAMES.items():
        yield "", name, samples["direction"] == direction
    for feed_mm_s in np.unique(samples["feed_mm_s"]):
        yield "", f"feed {SECONDS_PER_MINUTE * feed_mm_s:g} mm/min", samples["feed_mm_s"] == feed_mm_s
    for words, has in _circles(samples):
        yield "", words, has
    yield "", *_angle_range(_angle_deg(samples), worst)
    yield "", *_range("time {:.0f} to {:.0f} s", samples["time_s"], worst)
    if np.isfinite(samples["temperature_c"]).all():
        yield "", *_range("temperature {:.1f} to {:.1f} °C", samples["temperature_c"], worst)
    sliders_mm, travel = samples["sliders_mm"], samples[TRAVEL_DIRECTION]
    near = samples["since_reversal_s"] <= NEAR_REVERSAL_S
    for k in SLIDERS:
        subject = f"slider {k}"
        yield subject, *_range(f"{subject} between {{:.0f}} and {{:.0f}} mm", sliders_mm[:, k - 1], worst)
        yield subject, f"within {NEAR_REVERSAL_S:g} s after a reversal of {subject}", near[:, k - 1]
        yield subject, f"{subject} moving up", travel[:, k - 1] > 0.0
        yield subject, f"{subject} moving down", travel[:, k - 1] < 0.0


def _circles(samples: Samples) -> Iterator[tuple[str, Mask]]:
    """Yield the circles one by one: each has its height, tilt and set-up."""
    names, record, circle = record_names(samples.records), samples["record"], samples["circle"]
    several = len(np.unique(record)) > 1
    for row in distinct_rows(record, circle)[0]:
        which, number = record[row], circle[row]
        words = f"circle {number}" + (f" of {names[which]}" if several else "")
        yield words, (record == which) & (circle == number)


def _angle_deg(samples: Samples) -> FloatArray:
    angle_deg: FloatArray = np.degrees(samples["angle_rad"]) % 360.0
    return angle_deg


def _range(words: str, values: FloatArray, worst: Mask) -> tuple[str, Mask]:
    low, high = _shortest(np.sort(values[worst]))
    return words.format(low, high), (values >= low) & (values <= high)


def _angle_range(angle_deg: FloatArray, worst: Mask) -> tuple[str, Mask]:
    """Return the shortest arc, over 0 too: angles are unrolled from the largest gap between the worst samples."""
    angles = np.sort(angle_deg[worst])
    gaps = np.diff(angles, append=angles[0] + 360.0)
    begin = angles[(int(np.argmax(gaps)) + 1) % len(angles)]
    unrolled = (angle_deg - begin) % 360.0
    low, high = _shortest(np.sort(unrolled[worst]))
    words = f"angle {(low + begin) % 360.0:.0f} to {(high + begin) % 360.0:.0f} deg"
    return words, (unrolled >= low) & (unrolled <= high)


def _shortest(values: FloatArray) -> tuple[float, float]:
    """Return the shortest interval that holds `MOST` of some sorted values."""
    inside = max(int(np.ceil(MOST * len(values))), 1)
    widths = values[inside - 1 :] - values[: len(values) - inside + 1]
    first = int(np.argmin(widths))
    return float(values[first]), float(values[first + inside - 1])


def _rated(what: str, has: Mask, worst: Mask, residual_um: FloatArray) -> Circumstance:
    in_worst, in_all = float(has[worst].mean()), float(has.mean())
    return Circumstance(what, in_worst, in_all, _rms(residual_um[has]), _rms(residual_um[~has]))


def _rms(values: FloatArray) -> float | None:
    """Return the root mean square, None of no values."""
    return float(np.sqrt(np.mean(values**2))) if len(values) else None


def _shown(rms_um: float | None) -> str:
    return "-" if rms_um is None else f"{rms_um:.2f} µm"
