"""Lists of cases that studies of verdicts run: faults one at a time and several at once, clean machines."""

from __future__ import annotations

import itertools
import zlib
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from hexdbb_truth.forms import plans
from hexdbb_truth.forms.cases import CATALOGUED, DEVIATIONS, FAMILIES, TIMES_NOISE, Case
from hexdbb_truth.forms.outside import OUTSIDE
from hexdbb_truth.forms.sizes import UnreachableSizeError


def alone(
    half: str,
    kinds: Iterable[str] = CATALOGUED,
    deviations: Iterable[float] = DEVIATIONS,
    times_noise: Iterable[float] = TIMES_NOISE,
    seeds: Iterable[int] = range(5),
) -> Iterator[Case]:
    """Return single catalogue faults; `UnreachableSizeError` where a case is asked for what it hides tells its end."""
    for seed, kind, deviation, times in itertools.product(seeds, kinds, deviations, times_noise):
        yield Case((kind,), deviation, times, half, seed)


def outside(
    half: str,
    times_noise: Iterable[float] = TIMES_NOISE,
    seeds: Iterable[int] = range(5),
    kinds: Iterable[str] = tuple(OUTSIDE),
) -> Iterator[Case]:
    """Return faults that the catalogue does not have, one at a time."""
    for seed, times, kind in itertools.product(seeds, times_noise, kinds):
        yield Case((kind,), 0.0, times, half, seed)


def combined(
    half: str, number: int = 2, times_noise: float = 3.0, count: int = 40, deviation: float = 0.1
) -> Iterator[Case]:
    """Return combinations of catalogue faults that one plan can see, drawn evenly."""
    draw = np.random.default_rng([zlib.crc32(f"{half}/{number}".encode())])
    every = _on_one_plan(number)
    for seed in range(count):
        yield Case(every[int(draw.integers(len(every)))], deviation, times_noise, half, seed)


def unequal(
    half: str, times_noise: Sequence[float] = (3.0, 10.0, 30.0), count: int = 40, deviation: float = 0.1
) -> Iterator[Case]:
    """Return pairs of catalogue faults, each of another size than the other, drawn evenly."""
    draw = np.random.default_rng([zlib.crc32(f"{half}/unequal".encode())])
    every, sizes = _on_one_plan(2), list(itertools.permutations(times_noise, 2))
    for seed in range(count):
        kinds, times = every[int(draw.integers(len(every)))], sizes[int(draw.integers(len(sizes)))]
        yield Case(kinds, deviation, max(times), half, seed, times_each=times)


def _on_one_plan(number: int) -> list[tuple[str, ...]]:
    """Return the combinations of so many catalogue faults that one plan can see."""
    return [
        kinds
        for kinds in itertools.combinations(CATALOGUED, number)
        if sum(FAMILIES[kind].plan != "standard" for kind in kinds) < 2
    ]


def clean(half: str, seeds: Iterable[int] = range(60)) -> Iterator[Case]:
    """Return machines with errors of geometry and set-up alone, on plans in turn."""
    names = tuple(plans.PLANS)
    for seed in seeds:
        yield Case((), 0.0, 0.0, half, seed, names[seed % len(names)])


def reachable(cases: Iterable[Case]) -> Iterator[Case]:
    """Return those cases whose faults a machine in use can have."""
    for each in cases:
        try:
            each.hidden  # noqa: B018 - sizes are found here
        except UnreachableSizeError:
            continue
        yield each
