"""The ISO 230-4 quantities of a comparison, with name and symbol: one table for JSON, text and plots.

Definitions and edition are in `iso230`. A quantity that cannot be evaluated (one direction only, a capture that
was cut short) is None, never 0.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType

from hexdbb.comparison import iso230
from hexdbb.comparison.iso230 import FloatArray, Path

UM_PER_MM = 1000.0
"""Quantities are kept in mm and shown in micrometres."""

Quantities = Mapping[str, float | None]
"""Value in mm of each quantity by its key; None where it cannot be evaluated."""


@dataclass(frozen=True)
class Measurand:
    """Input of a quantity: one direction's path, and the other's if there is one."""

    own: Path
    other: Path | None

    @cached_property
    def centre_mm(self) -> FloatArray:
        """The set-up's centre offset (2,), of both directions together."""
        return iso230.set_up_centre_mm(self.own, *(() if self.other is None else (self.other,)))


@dataclass(frozen=True)
class Quantity:
    """One quantity of the table.

    Attributes
    ----------
    key : str
        Name in JSON, without the unit's suffix.
    symbol : str
        Symbol in tables and plots.
    name : str
        Name in words.
    of_both : bool
        Whether it takes both directions; it is then the same for either.
    evaluate : callable
        Value in mm of a `Measurand`; None where a path it needs is missing.
    """

    key: str
    symbol: str
    name: str
    of_both: bool
    evaluate: Callable[[Measurand], float | None]


def _of_both(evaluate: Callable[[Path, Path], float]) -> Callable[[Measurand], float | None]:
    def when_both(measurand: Measurand) -> float | None:
        return None if measurand.other is None else evaluate(measurand.own, measurand.other)

    return when_both


QUANTITIES: tuple[Quantity, ...] = (
    Quantity(
        "circular_deviation",
        "G",
        "circular deviation",
        False,
        lambda m: iso230.circular_deviation_mm(m.own),
    ),
    Quantity(
        "bidirectional_circular_deviation",
        "G(b)",
        "bi-directional circular deviation",
        True,
        _of_both(iso230.bidirectional_circular_deviation_mm),
    ),
    Quantity("circular_hysteresis", "H", "circular hysteresis", True, _of_both(iso230.circular_hysteresis_mm)),
    Quantity(
        "mean_bidirectional_radial_deviation",
        "D",
        "mean bi-directional radial deviation",
        True,
        _of_both(iso230.mean_bidirectional_radial_deviation_mm),
    ),
    Quantity(
        "radial_deviation_max",
        "F max",
        "radial deviation, largest, centre offset removed (least squares)",
        False,
        lambda m: iso230.radial_deviation(m.own, m.centre_mm).max_mm,
    ),
    Quantity(
        "radial_deviation_min",
        "F min",
        "radial deviation, smallest, centre offset removed (least squares)",
        False,
        lambda m: iso230.radial_deviation(m.own, m.centre_mm).min_mm,
    ),
    Quantity(
        "radial_deviation_max_with_offset",
        "F max*",
        "radial deviation, largest, centre offset kept",
        False,
        lambda m: iso230.radial_deviation(m.own, None).max_mm,
    ),
    Quantity(
        "radial_deviation_min_with_offset",
        "F min*",
        "radial deviation, smallest, centre offset kept",
        False,
        lambda m: iso230.radial_deviation(m.own, None).min_mm,
    ),
)


def evaluate_quantities(paths: Mapping[int, Path], chosen: Sequence[Quantity] = QUANTITIES) -> dict[int, Quantities]:
    """Evaluate the quantities of each direction of one circle at one feed.

    Parameters
    ----------
    paths : mapping
        Mean path by direction, +1 counter-clockwise and -1 clockwise; one of them may be missing. A path that is not a
        full circle counts as missing for the other direction, and has no quantities itself.
    chosen : sequence of Quantity
        Those that are evaluated.

    Returns
    -------
    dict
        For each direction given, every key of `chosen`; those of both directions are evaluated once.
    """
    full = {direction: path for direction, path in paths.items() if path.is_full_circle}
    values: dict[int, Quantities] = dict.fromkeys(paths, MappingProxyType(dict.fromkeys(q.key for q in chosen)))
    of_both: dict[str, float | None] = {}
    for direction, own in full.items():
        measurand = Measurand(own, full.get(-direction))
        of_both = of_both or {q.key: q.evaluate(measurand) for q in chosen if q.of_both}
        of_own = {q.key: q.evaluate(measurand) for q in chosen if not q.of_both}
        values[direction] = MappingProxyType({q.key: (of_both | of_own)[q.key] for q in chosen})
    return values
