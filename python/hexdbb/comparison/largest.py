"""The largest value of some ISO 230-4 quantities on any circle, feed and direction: one number each for a record."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hexdbb.comparison.circles import DIRECTION_NAMES, lap_mean_path
from hexdbb.comparison.quantities import QUANTITIES, Quantities, Quantity, evaluate_quantities
from hexdbb.samples import Samples
from hexdbb.samples.distinct import distinct_rows


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
    first, member = distinct_rows(samples["set_up"], samples["feed_mm_s"])
    for number in range(len(first)):
        part = samples.part(member == number)
        record = samples.records[int(part["record"][0])]
        circle, bar_mm = record.circle(int(part["circle"][0])), record.gauge.bar_length_mm
        paths = {}
        for direction in DIRECTION_NAMES:
            own = part.part(part["direction"] == direction)
            if len(own):
                paths[direction] = lap_mean_path(own, circle, bar_mm, own.reading_mm)
        yield from evaluate_quantities(paths, chosen).values()
