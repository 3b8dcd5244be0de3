"""The cases of the honest tests: every effect of the catalogue alone, pairs, nothing, and faults outside the catalogue.

A case is told by its name: `backlash-x3-s7` is backlash of three times the noise in the machine of seed 7,
`backlash+bar_drift-x3-s0` a pair, `none-s4` a machine without a fault. The seed draws geometry, set-up, noise, and what
a mechanism has besides its size: element, phase, place, time. So every case can be made again, alone and anywhere.
"""

from __future__ import annotations

import itertools
import re
import zlib
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hexdbb.errors import InputError
from hexdbb.plan import Plan
from hexdbb.record import Record
from hexdbb.rig.mechanisms import CATALOGUED, MECHANISMS, OUTSIDE, MechanismTable
from hexdbb.rig.truth import TruthFile, random_truth
from hexdbb_truth.plans import PACE, discovery_plan, off_radius_plan, tilted_plan, two_mounts_plan
from hexdbb_truth.simulate import Pace, simulate
from hexdbb_truth.sizes import sized

TIMES_NOISE = (1.0, 3.0, 10.0)
SEEDS = range(20)
NAME = re.compile(r"(?P<kinds>[a-z_]+(?:\+[a-z_]+)*)-x(?P<times>\d+(?:\.\d+)?)-s(?P<seed>\d+)|none-s(?P<clean>\d+)")

Draw = np.random.Generator
Maker = Callable[[Draw], dict[str, object]]


def _slider(draw: Draw) -> int:
    return int(draw.integers(1, 7))


def _phase(draw: Draw) -> float:
    return round(float(draw.uniform(0.0, 360.0)), 1)


def _direction(draw: Draw) -> list[float]:
    """Return a vector of 10 µm in any direction."""
    vector = draw.normal(size=3)
    return [float(each) for each in 10.0 * vector / np.linalg.norm(vector)]


def _bow(draw: Draw) -> dict[str, object]:
    angle = draw.uniform(0.0, 2.0 * np.pi)
    lateral, vertical = float(100.0 * np.cos(angle)), float(100.0 * np.sin(angle))
    return {"guideway": int(draw.integers(1, 4)), "lateral_um": lateral, "vertical_um": vertical}


MAKERS: dict[str, Maker] = {
    "backlash": lambda draw: {"slider": _slider(draw), "width_um": 10.0},
    "reversal_spike": lambda draw: {
        "slider": _slider(draw),
        "breakaway_um": 20.0,
        "decay_s": float(draw.uniform(0.2, 0.6)),
    },
    "pitch_cyclic": lambda draw: {
        "slider": _slider(draw),
        "amplitude_um": 5.0,
        "phase_deg": _phase(draw),
        "second_amplitude_um": 2.0,
        "second_phase_deg": _phase(draw),
    },
    "lead_error": lambda draw: {"slider": _slider(draw), "error_um_m": 100.0 * float(draw.choice([-1.0, 1.0]))},
    "straightness": _bow,
    "servo_lag": lambda draw: {"slider": _slider(draw), "lag_ms": 1.0},
    "leg_thermal": lambda draw: {"growth_um": 100.0, "time_constant_s": float(draw.uniform(500.0, 3000.0))},
    "screw_thermal": lambda draw: {
        "slider": _slider(draw),
        "growth_um_m": 50.0,
        "time_constant_s": float(draw.uniform(1000.0, 4000.0)),
    },
    "gravity_sag": lambda draw: {"compliance_um_n": 0.2},
    "joint_offset": lambda draw: {"leg": _slider(draw), "offset_um": _direction(draw)},
    "bar_drift": lambda draw: {"rate_um_min": 0.5 * float(draw.choice([-1.0, 1.0]))},
    "bar_gain": lambda draw: {"error_percent": float(draw.choice([-1.0, 1.0]))},
    "sample_delay": lambda draw: {"delay_ms": 10.0 * float(draw.choice([-1.0, 1.0]))},
    "ball_eccentricity": lambda draw: {"offset_um": _direction(draw), "mount": 1},
    "dent": lambda draw: {
        "guideway": int(draw.integers(1, 4)),
        "depth_um": 20.0,
        "at_mm": float(draw.uniform(220.0, 300.0)),
        "width_mm": float(draw.uniform(2.0, 8.0)),
    },
    "mains_pickup": lambda draw: {
        "amplitude_um": 1.0,
        "frequency_hz": float(50.0 + draw.normal(0.0, 0.02)),
        "phase_deg": _phase(draw),
    },
    "loose_cup": lambda draw: {"shift_um": _direction(draw), "at_s": float(draw.uniform(300.0, 1500.0))},
    "stick_slip": lambda draw: {
        "slider": _slider(draw),
        "tooth_um": 20.0,
        "way_mm": float(draw.uniform(1.0, 6.0)),
        "begin_s": float(draw.uniform(0.0, 1200.0)),
        "duration_s": float(draw.uniform(100.0, 400.0)),
    },
    "guideway_bend": lambda draw: {
        "guideway": int(draw.integers(1, 4)),
        "vertical_um": 50.0,
        "time_constant_s": float(draw.uniform(300.0, 1500.0)),
    },
    # A magnetic encoder: its poles are far enough apart for an error of many micrometres.
    "encoder_interpolation": lambda draw: {
        "slider": _slider(draw),
        "amplitude_um": 5.0,
        "period_um": 2000.0,
        "phase_deg": _phase(draw),
    },
}
"""What the seed draws for each kind; the size is set afterwards."""

PLANS: dict[str, Callable[[], Plan]] = {
    "bar_gain": off_radius_plan,
    "ball_eccentricity": two_mounts_plan,
    "leg_thermal": tilted_plan,
}
"""Kinds that need more than the discovery plan to be seen."""


@dataclass(frozen=True)
class Hidden:
    """What a case hides: the kind of mechanism, its element (from 1; None: the whole machine), and what it is."""

    kind: str
    element: int | None
    mechanism: MechanismTable


@dataclass(frozen=True)
class Case:
    """One test of discovery; computed when asked.

    Attributes
    ----------
    kinds : tuple of str
        Mechanisms hidden in the machine; none in a clean one.
    times_noise : float
        What each leaves in the readings beyond geometry and set-up, in multiples of the noise.
    seed : int
        Of all that is drawn.
    pace : Pace
        How time is cut.
    """

    kinds: tuple[str, ...]
    times_noise: float
    seed: int
    pace: Pace = PACE

    @property
    def name(self) -> str:
        """Return the name that `case` understands."""
        return f"{'+'.join(self.kinds)}-x{self.times_noise:g}-s{self.seed}" if self.kinds else f"none-s{self.seed}"

    @property
    def catalogued(self) -> bool:
        """Whether the catalogue has an effect for everything that is hidden."""
        return all(kind in CATALOGUED for kind in self.kinds)

    @cached_property
    def plan(self) -> Plan:
        """What is driven."""
        needed = [PLANS[kind] for kind in self.kinds if kind in PLANS]
        return needed[0]() if needed else discovery_plan()

    @cached_property
    def hidden(self) -> tuple[Hidden, ...]:
        """What is to be found."""
        machine = random_truth(self.seed)
        found = []
        for kind in self.kinds:
            table = sized(drawn(kind, self.seed), machine, self.plan, self.pace, self.times_noise)
            found.append(Hidden(kind, element_of(table), table))
        return tuple(found)

    @cached_property
    def truth(self) -> TruthFile:
        """The machine, with what is hidden in it."""
        return random_truth(self.seed).model_copy(update={"mechanism": tuple(each.mechanism for each in self.hidden)})

    def record(self, temperature: bool | None = None) -> Record:
        """Measure it; with a thermometer in every second seed where nothing is said, whatever is hidden."""
        read = bool(self.seed % 2) if temperature is None else temperature
        return simulate(self.truth, self.plan, pace=self.pace, temperature=read)


def drawn(kind: str, seed: int) -> MechanismTable:
    """Return a mechanism of a kind, of any size; its element, phase and times are drawn."""
    # By name, so that a kind draws the same whatever else is hidden, and on every machine.
    draw = np.random.default_rng([seed, zlib.crc32(kind.encode())])
    return MECHANISMS[kind].model_validate(MAKERS[kind](draw))


def element_of(table: MechanismTable) -> int | None:
    """Return the slider, guideway or leg of a mechanism, from 1; None where it is of the whole machine."""
    return next((getattr(table, key) for key in ("slider", "guideway", "leg") if hasattr(table, key)), None)


def amount_of(table: MechanismTable) -> float:
    """Return the size of a mechanism in its own unit: the root of the sum of squares of its `sizes`."""
    return float(np.linalg.norm(np.concatenate([np.ravel(getattr(table, key)) for key in table.sizes])))


def unit_of(kind: str) -> str:
    """Return the unit of a kind's size, ASCII as in files (`um/m`): that of the key in a truth file."""
    key = MECHANISMS[kind].sizes[0]
    unit = key.partition("_")[2]
    return "%" if unit == "percent" else unit.replace("_n", "_N").replace("_", "/")


def case(name: str, pace: Pace = PACE) -> Case:
    """Return the case of a name.

    Raises
    ------
    InputError
        No case is called so.
    """
    match = NAME.fullmatch(name)
    if match is None:
        raise InputError(f'case "{name}" (expected KIND-xTIMES-sSEED, KIND+KIND-xTIMES-sSEED or none-sSEED)')
    if match["clean"] is not None:
        return Case((), 0.0, int(match["clean"]), pace)
    kinds = tuple(match["kinds"].split("+"))
    unknown = [kind for kind in kinds if kind not in MAKERS]
    if unknown:
        raise InputError(f'case "{name}": kind "{unknown[0]}" (expected one of {", ".join(MAKERS)})')
    return Case(kinds, float(match["times"]), int(match["seed"]), pace)


def alone(
    kinds: Iterable[str] = tuple(CATALOGUED),
    times_noise: Iterable[float] = TIMES_NOISE,
    seeds: Iterable[int] = SEEDS,
) -> Iterator[Case]:
    """Return one mechanism at a time: every kind, in every size, in every seed's machine."""
    for kind, times, seed in itertools.product(kinds, times_noise, seeds):
        yield Case((kind,), times, seed)


def outside(times_noise: Iterable[float] = TIMES_NOISE, seeds: Iterable[int] = SEEDS) -> Iterator[Case]:
    """Return faults that no effect of the catalogue describes, one at a time."""
    return alone(tuple(OUTSIDE), times_noise, seeds)


def pairs(times_noise: float = 3.0, seed: int = 0) -> Iterator[Case]:
    """Return every pair of catalogued mechanisms that one plan can see, each in another machine."""
    for index, kinds in enumerate(itertools.combinations(CATALOGUED, 2)):
        if sum(kind in PLANS for kind in kinds) < 2:
            yield Case(kinds, times_noise, seed + index)


def clean(seeds: Iterable[int] = range(60)) -> Iterator[Case]:
    """Return machines with errors of geometry and set-up alone."""
    for seed in seeds:
        yield Case((), 0.0, seed)


def every() -> Iterator[Case]:
    """Return all cases of the honest tests."""
    return itertools.chain(clean(), alone(), outside(), pairs())
