"""Where sliders reverse on a circle: play, sticking and hysteresis show there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hexdbb.comparison.iso230 import FloatArray
from hexdbb.samples import Samples
from hexdbb.samples.distinct import distinct_rows

APART_DEG = 10.0
"""Distance from which two reversals of one slider are two: it reverses where its velocity changes sign, twice a turn
and far apart; noise of the encoders and the lag of both directions spread one over a degree or two."""
OFTEN = 0.5
"""Part of the laps in which a reversal must be seen: starts and stops of a run are none."""
TURN_DEG = 360.0


@dataclass(frozen=True)
class Reversal:
    """A slider (1 to 6) reverses at a commanded polar angle."""

    slider: int
    angle_deg: float


def reversals(part: Samples) -> tuple[Reversal, ...]:
    """Find where sliders reverse.

    Parameters
    ----------
    part : Samples
        One circle at one feed, both directions; in the order of time within a sweep.

    Returns
    -------
    tuple of Reversal
        By angle.
    """
    laps = len(distinct_rows(part["sweep"], part["lap"])[0])
    travel, angle_deg = part["travel_direction"], np.degrees(part["angle_rad"]) % TURN_DEG
    same_sweep = np.diff(part["sweep"]) == 0
    found = []
    for slider in range(6):
        turned = np.flatnonzero(same_sweep & (travel[1:, slider] * travel[:-1, slider] < 0.0)) + 1
        for group in _groups(np.sort(angle_deg[turned])):
            if len(group) >= OFTEN * laps:
                found.append(Reversal(slider + 1, float(np.median(group)) % TURN_DEG))
    return tuple(sorted(found, key=lambda each: each.angle_deg))


def _groups(sorted_deg: FloatArray) -> list[FloatArray]:
    """Split sorted angles at gaps; a group over 0 is unrolled beyond 360 degrees."""
    if not len(sorted_deg):
        return []
    groups: list[FloatArray] = np.split(sorted_deg, np.flatnonzero(np.diff(sorted_deg) > APART_DEG) + 1)
    if len(groups) > 1 and groups[0][0] + TURN_DEG - groups[-1][-1] <= APART_DEG:
        groups[-1] = np.concatenate([groups[-1], groups.pop(0) + TURN_DEG])
    return groups
