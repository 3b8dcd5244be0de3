"""Pass or fail of circles against tolerances of ISO 230-4 quantities."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from hexdbb.comparison import UM_PER_MM, CircleComparison
from hexdbb.comparison.circles import SHORT_DIRECTION_NAMES, DirectionComparison
from hexdbb.errors import InputError
from hexdbb.machine import Tolerance


@dataclass(frozen=True)
class _Toleranced:
    """A quantity that may have a tolerance: symbol, key in files, and its size (mm) of one direction."""

    symbol: str
    key: str
    of_both: bool
    size_mm: Callable[[DirectionComparison], float | None]


def _largest_f(part: DirectionComparison) -> float | None:
    found = [part.measured_quantities[key] for key in ("radial_deviation_max", "radial_deviation_min")]
    known = [abs(each) for each in found if each is not None]
    return max(known, default=None)


_QUANTITIES = (
    _Toleranced("G", "circular_deviation_um", False, lambda part: part.measured_quantities["circular_deviation"]),
    _Toleranced(
        "G(b)",
        "bidirectional_circular_deviation_um",
        True,
        lambda part: part.measured_quantities["bidirectional_circular_deviation"],
    ),
    _Toleranced("F", "radial_deviation_um", False, _largest_f),
)


@dataclass(frozen=True)
class Judged:
    """One quantity of one record against its tolerance.

    Attributes
    ----------
    record_name, symbol : str
    limit_um : float
    worst_um : float or None
        Largest value on any circle; None where it cannot be evaluated.
    where : str
        Circle, feed and direction of the largest value.
    """

    record_name: str
    symbol: str
    limit_um: float
    worst_um: float | None
    where: str

    @property
    def passes(self) -> bool | None:
        """Whether it is within the tolerance; None where it cannot be evaluated."""
        return None if self.worst_um is None else self.worst_um <= self.limit_um

    @property
    def word(self) -> str:
        """The judgement in a word."""
        return {True: "pass", False: "fail", None: "not evaluated"}[self.passes]


def parse_tolerance(texts: Sequence[str]) -> Tolerance | None:
    """Read tolerances as ``G=20``, ``G(b)=25``, ``F=15``, µm; None where there are none.

    Raises
    ------
    InputError
        Another quantity, one twice, or a value that is not a number above zero.
    """
    by_symbol = {each.symbol.lower(): each.key for each in _QUANTITIES}
    found: dict[str, float] = {}
    for text in (part.strip() for whole in texts for part in whole.split(",")):
        symbol, _, value = text.partition("=")
        key = by_symbol.get(symbol.strip().lower())
        try:
            limit_um = float(value)
        except ValueError:
            limit_um = 0.0
        if key is None or key in found or not 0.0 < limit_um < float("inf"):
            symbols = ", ".join(f"{each.symbol}=UM" for each in _QUANTITIES)
            raise InputError(f'--tolerance "{text}": expected {symbols}, each once, with a number of µm above zero')
        found[key] = limit_um
    return Tolerance.model_validate(found) if found else None


def judge(circles: Sequence[CircleComparison], tolerance: Tolerance | None) -> tuple[Judged, ...]:
    """Judge every record by the tolerances there are; nothing without any."""
    if tolerance is None:
        return ()
    names = dict.fromkeys(each.record_name for each in circles)
    return tuple(
        _judged(name, quantity, limit_um, [each for each in circles if each.record_name == name])
        for name in names
        for quantity in _QUANTITIES
        if (limit_um := getattr(tolerance, quantity.key)) is not None
    )


def _judged(name: str, quantity: _Toleranced, limit_um: float, circles: Sequence[CircleComparison]) -> Judged:
    worst = max(_sizes(quantity, circles), default=None)
    if worst is None:
        return Judged(name, quantity.symbol, limit_um, None, "no full circle")
    return Judged(name, quantity.symbol, limit_um, worst[0], worst[1])


def _sizes(quantity: _Toleranced, circles: Sequence[CircleComparison]) -> Iterator[tuple[float, str]]:
    for circle in circles:
        for part in circle.directions[:1] if quantity.of_both else circle.directions:
            size_mm = quantity.size_mm(part)
            if size_mm is not None:
                direction = "" if quantity.of_both else f", {SHORT_DIRECTION_NAMES[part.direction]}"
                yield UM_PER_MM * size_mm, f"circle {circle.circle.id} at {circle.feed_mm_min:g} mm/min{direction}"
