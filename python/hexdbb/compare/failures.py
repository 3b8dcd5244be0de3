"""What the samples with the largest residuals have in common, in words.

The residual is averaged over arcs of ten degrees of each capture first, so that single noisy readings do not count. The
worst arcs, those at least half as bad as the worst of all and at most a tenth of the samples, are held against all: a
trait that most of the worst have and few of all is where the model fails. Ranges (angle, position, time) are the
shortest that hold `MOST` of the worst.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.compare.circles import DIRECTION_NAMES
from hexdbb.compare.iso230 import FloatArray
from hexdbb.predictors.columns import SLIDERS, Columns, codes

ARC_DEG = 10.0
WORST_PART = 0.1
AS_BAD = 0.5
MOST = 0.7
"""A trait is common where so many of the worst samples have it ..."""
TIMES_OVER = 1.5
"""... and they have it so many times more often than all samples."""
NEAR_REVERSAL_S = 1.0
MOST_NAMED = 6

Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Trait:
    """Something samples may have in common.

    Attributes
    ----------
    what : str
        In words: ``within 1 s of a reversal of slider 4``.
    in_worst, in_all : float
        Part of the worst samples, and of all, that have it.
    rms_with_um, rms_without_um : float
        Residual of all samples that have it, and of the others; nan where there are none.
    """

    what: str
    in_worst: float
    in_all: float
    rms_with_um: float
    rms_without_um: float


@dataclass(frozen=True)
class Failures:
    """The worst samples: how many, how wrong, and what they have in common, the most telling trait first."""

    samples: int
    rms_um: float
    rms_elsewhere_um: float
    common: tuple[Trait, ...]

    @property
    def sentences(self) -> list[str]:
        """Say it in words."""
        first = (
            f"the worst {self.samples} samples: residual {self.rms_um:.2f} µm rms,"
            f" the others {self.rms_elsewhere_um:.2f} µm"
        )
        if not self.common:
            return [f"{first}; they have nothing in common that the others have not"]
        return [first, *(_sentence(trait) for trait in self.common)]


def failures(columns: Columns) -> Failures:
    """Find the worst samples and what they have in common.

    Parameters
    ----------
    columns : dict of str to (n,) arrays
        As `hexdbb.predictors.sample_columns` gives them.
    """
    residual_um = columns["residual_um"]
    worst = _worst(columns)
    found = (_judged(what, has, worst, residual_um) for what, has in _traits(columns, worst))
    common = [trait for trait in found if trait.in_worst >= MOST and trait.in_worst >= TIMES_OVER * trait.in_all]
    common.sort(key=lambda trait: trait.in_all / trait.in_worst)
    return Failures(int(worst.sum()), _rms(residual_um[worst]), _rms(residual_um[~worst]), tuple(common[:MOST_NAMED]))


def _worst(columns: Columns) -> Mask:
    """Samples of the arcs with the largest root mean square: `AS_BAD` as the worst, up to `WORST_PART` of all."""
    arc = np.floor((columns["angle_deg"] % 360.0) / ARC_DEG + 1e-9).astype(np.int64)
    keys = np.column_stack([codes(columns["record"]), columns["sweep"], columns["lap"], arc])
    arc_of = np.unique(keys, axis=0, return_inverse=True)[1].ravel()
    size = np.bincount(arc_of)
    squared = np.bincount(arc_of, columns["residual_um"] ** 2) / size
    order = np.argsort(-squared, kind="stable")
    as_bad = int(np.sum(squared >= AS_BAD**2 * squared[order[0]]))
    most = int(np.searchsorted(np.cumsum(size[order]), WORST_PART * len(arc_of), side="right"))
    return np.isin(arc_of, order[: max(min(as_bad, most), 1)])


def _traits(columns: Columns, worst: Mask) -> Iterator[tuple[str, Mask]]:
    for direction, name in DIRECTION_NAMES.items():
        yield name, columns["direction"] == direction
    for feed in np.unique(columns["feed_mm_min"]):
        yield f"feed {feed:g} mm/min", columns["feed_mm_min"] == feed
    yield from _circles(columns)
    yield _angle_range(columns["angle_deg"] % 360.0, worst)
    yield _range("time {:.0f} to {:.0f} s", columns["t_s"], worst)
    if "temperature_c" in columns and np.isfinite(columns["temperature_c"]).all():
        yield _range("temperature {:.1f} to {:.1f} °C", columns["temperature_c"], worst)
    for k in SLIDERS:
        yield _range(f"slider {k} between {{:.0f}} and {{:.0f}} mm", columns[f"s{k}_mm"], worst)
        if f"since_reversal{k}_s" in columns:
            near = columns[f"since_reversal{k}_s"] <= NEAR_REVERSAL_S
            yield f"within {NEAR_REVERSAL_S:g} s after a reversal of slider {k}", near
        if f"side{k}" in columns:
            yield f"slider {k} moving up", columns[f"side{k}"] > 0.0
            yield f"slider {k} moving down", columns[f"side{k}"] < 0.0


def _circles(columns: Columns) -> Iterator[tuple[str, Mask]]:
    """Circles one by one: each has its height, tilt and set-up."""
    several = len(np.unique(columns["record"])) > 1
    for record in np.unique(columns["record"]):
        here = columns["record"] == record
        for circle in np.unique(columns["circle"][here]):
            yield f"circle {circle}" + (f" of {record}" if several else ""), here & (columns["circle"] == circle)


def _range(words: str, values: FloatArray, worst: Mask) -> tuple[str, Mask]:
    low, high = _shortest(np.sort(values[worst]))
    return words.format(low, high), (values >= low) & (values <= high)


def _angle_range(angle_deg: FloatArray, worst: Mask) -> tuple[str, Mask]:
    """Shortest arc, over 0 too: angles are unrolled from the largest gap between the worst samples."""
    angles = np.sort(angle_deg[worst])
    gaps = np.diff(angles, append=angles[0] + 360.0)
    begin = angles[(int(np.argmax(gaps)) + 1) % len(angles)]
    unrolled = (angle_deg - begin) % 360.0
    low, high = _shortest(np.sort(unrolled[worst]))
    words = f"angle {(low + begin) % 360.0:.0f} to {(high + begin) % 360.0:.0f} deg"
    return words, (unrolled >= low) & (unrolled <= high)


def _shortest(values: FloatArray) -> tuple[float, float]:
    """Shortest interval that holds `MOST` of some sorted values."""
    inside = max(int(np.ceil(MOST * len(values))), 1)
    widths = values[inside - 1 :] - values[: len(values) - inside + 1]
    first = int(np.argmin(widths))
    return float(values[first]), float(values[first + inside - 1])


def _judged(what: str, has: Mask, worst: Mask, residual_um: FloatArray) -> Trait:
    return Trait(what, float(has[worst].mean()), float(has.mean()), _rms(residual_um[has]), _rms(residual_um[~has]))


def _sentence(trait: Trait) -> str:
    return (
        f"{100.0 * trait.in_worst:.0f} % of them, {100.0 * trait.in_all:.0f} % of all: {trait.what}"
        f" ({trait.rms_with_um:.2f} µm rms there, {trait.rms_without_um:.2f} µm elsewhere)"
    )


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2))) if len(values) else float("nan")
