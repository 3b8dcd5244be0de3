"""The largest value of some ISO 230-4 quantities on any circle, feed and direction: one number each for a record."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hexdbb.comparison.circles import numbered_turns
from hexdbb.comparison.iso230 import Path, lap_mean_path
from hexdbb.comparison.quantities import QUANTITIES, Quantities, Quantity, evaluate_quantities
from hexdbb.samples import Samples
from hexdbb.samples.distinct import distinct_rows, rows_by_number


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
    of_circle: dict[tuple[int, float], dict[int, Path]] = {}
    columns = [samples[name] for name in ("angle_rad", "reading_mm", "sweep", "lap")]
    for row, rows in zip(first, rows_by_number(member), strict=True):
        angle_rad, reading_mm, sweep, lap = (column[rows] for column in columns)
        record = samples.records[int(samples["record"][row])]
        circle = record.circle(int(samples["circle"][row]))
        deviation_mm = reading_mm + (record.gauge.bar_length_mm - circle.radius_mm)
        path = lap_mean_path(angle_rad, deviation_mm, circle.radius_mm, numbered_turns(sweep, lap))
        key = int(samples["set_up"][row]), float(samples["feed_mm_s"][row])
        of_circle.setdefault(key, {})[int(samples["direction"][row])] = path
    for paths in of_circle.values():
        yield from evaluate_quantities(paths, chosen).values()
