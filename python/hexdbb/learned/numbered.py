"""Names of variables that carry numbers, which the readings chose: instants, periods, times that memory lasts.

Steps at instants are `step@12.5/340.2`; the others are what repeats (`repeating`), what follows another variable
(`following`) and parts of vectors along a direction (`directed`).
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import replace

from hexdbb.learned.directed import ALONG, along
from hexdbb.learned.following import (
    BY_NUMBER,
    CREEP,
    HEATED,
    RELAY,
    TURNING,
    creep,
    following,
    is_relay,
    may_be_heated,
    two_states,
)
from hexdbb.learned.repeating import (
    BY_FEED,
    BY_MOUNT,
    FAST_DIGITS,
    REPEATING,
    WAVE,
    WAVES,
    by_direction,
    by_feed,
    by_mount,
    periodic,
    wave,
)
from hexdbb.learned.signs import turns_with
from hexdbb.learned.variable import NUMBERED, Variable

INSTANT_S = 1e-4
"""Resolution of instants in names: far below the time between two samples."""


def step(instants_s: Sequence[float]) -> Variable:
    """Return the variable of steps at some instants, rounded down to what its name holds."""
    kept = sorted({math.floor(each / INSTANT_S + 1e-6) * INSTANT_S for each in instants_s})
    names = [f"{each:.4f}".rstrip("0").rstrip(".") for each in kept]
    at = tuple(float(each) for each in names)
    return Variable(f"step@{'/'.join(names)}", "time_s", "s", "time", len(at), instants=at)


def has_chosen_number(variable: Variable) -> bool:
    """Whether its name carries a number that readings chose, and that can be moved a little: a period, a constant."""
    return "@" in variable.name and not variable.instants and not is_relay(variable)


def number_of(variable: Variable) -> float:
    """Return the number in a variable's name: a period (s or mm), a time constant (s), an angle (degrees)."""
    return float(variable.name.partition("@")[2])


def with_number(variable: Variable, number: float, variables: Sequence[Variable]) -> Variable:
    """Return a variable with another period or time constant, as many splines as before.

    Parameters
    ----------
    variable : Variable
    number : float
    variables : sequence of Variable
        Those at its place, of which it may remember one.
    """
    kind = variable.name.partition("@")[0]
    found = numbered(f"{kind}@{number:.{FAST_DIGITS}g}", variables)
    assert found is not None  # the variable has such a name
    return replace(found, count=variable.count)


def numbered(name: str, variables: Sequence[Variable]) -> Variable | None:
    """Return the variable whose name carries numbers, at a place of such variables; None where it is not of the kind.

    Parameters
    ----------
    name : str
    variables : sequence of Variable
        Those at the place, of which it may remember one.
    """
    of, relay, _ = name.rpartition(f"_{RELAY}{NUMBERED}")
    kind = f"{of}_{RELAY}" if relay else name.partition(NUMBERED)[0]
    numbers = name.removeprefix(f"{kind}{NUMBERED}")
    if not re.fullmatch(r"-?\d+(\.\d+)?(e[+-]?\d+)?(/-?\d+(\.\d+)?(e[+-]?\d+)?)*", numbers):
        return None
    values = [float(each) for each in numbers.split("/")]
    if kind == "step":
        return step(values)
    if relay:
        whose = next((each for each in variables if each.name == of), None) or numbered(of, variables)
        is_pair = len(values) == 2 and values[0] < values[1]
        return two_states(whose, *values) if whose is not None and is_pair else None
    if len(values) != 1 or values[0] <= 0.0:
        return None
    if kind in (f"{each}_period" for each in REPEATING):
        return periodic(kind.removesuffix("_period"), values[0])
    if kind == BY_FEED:
        return by_feed(periodic("time", values[0]))
    if kind == BY_MOUNT:
        return by_mount(values[0])
    if kind == CREEP:
        return creep(values[0])
    if kind == "direction_position_period":
        return by_direction(periodic("position", values[0]))
    of, _, how = kind.rpartition("_")
    if how == ALONG:
        listed = next((each for each in variables if each.name.startswith(f"{kind}@")), None)
        return replace(along(of, values[0]), count=listed.count, is_coarse=listed.is_coarse) if listed else None
    known = {each.name: each for each in variables}
    if how == WAVE:
        return wave(known[of], values[0]) if of in WAVES and of in known else None
    if how not in BY_NUMBER or of not in known or (how == TURNING and turns_with(known[of]) is None):
        return None
    if how == HEATED and not may_be_heated(known[of]):
        return None
    return following(known[of], how, values[0])
