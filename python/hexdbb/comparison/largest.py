"""The largest value of some ISO 230-4 quantities on any circle, feed and direction: one number each for a record."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from hexdbb.comparison.circles import numbered_turns
from hexdbb.comparison.iso230 import Path, lap_mean_paths
from hexdbb.comparison.quantities import QUANTITIES, Quantities, Quantity, evaluate_quantities
from hexdbb.samples import Samples
from hexdbb.samples.distinct import Ints, distinct_rows, rows_by_number


def largest_quantities(samples: Samples, keys: Sequence[str]) -> Quantities:
    """Evaluate some quantities of the measured paths, and no other.

    Parameters
    ----------
    samples : Samples
        At least one; readings as measured.
    keys : sequence of str
        Of `QUANTITIES`.

    Returns
    -------
    mapping of str to float or None
        Largest value, mm; None where no circle is driven so that it can be evaluated.
    """
    chosen = [each for each in QUANTITIES if each.key in keys]
    found: dict[str, list[float]] = {key: [] for key in keys}
    for values in _of_circles(samples, chosen):
        for key, known in found.items():
            if (value := values[key]) is not None:
                known.append(value)
    return {key: max(known, default=None) for key, known in found.items()}


def _of_circles(samples: Samples, chosen: list[Quantity]) -> Iterator[Quantities]:
    """Yield the quantities of every circle, feed and direction."""
    first, member = distinct_rows(samples["set_up"], samples["feed_mm_s"], samples["direction"])
    which = [(samples.records[record], circle) for record, circle in _pairs(samples, ("record", "circle"), first)]
    circles = [record.circle(circle) for record, circle in which]
    radius_mm = [circle.radius_mm for circle in circles]
    offset_mm = np.array([record.gauge.bar_length_mm for record, _ in which]) - radius_mm
    paths = lap_mean_paths(
        samples["angle_rad"],
        samples["reading_mm"] + offset_mm[member],
        numbered_turns(samples["sweep"], samples["lap"]),
        rows_by_number(member),
        radius_mm,
    )
    of_circle: dict[tuple[int, float], dict[int, Path]] = {}
    keys = _pairs(samples, ("set_up", "feed_mm_s"), first)
    for key, direction, path in zip(keys, samples["direction"][first].tolist(), paths, strict=True):
        of_circle.setdefault(key, {})[int(direction)] = path
    for each in of_circle.values():
        yield from evaluate_quantities(each, chosen).values()


def _pairs(samples: Samples, names: tuple[str, str], rows: Ints) -> list[tuple[Any, Any]]:
    """Return the values of two columns in some rows."""
    one, other = (samples[name][rows].tolist() for name in names)
    return list(zip(one, other, strict=True))
