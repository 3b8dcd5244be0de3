"""Variables whose names carry numbers, which the readings chose: instants, periods, and times that memory lasts.

Steps at instants (`step@12.5/340.2`), what repeats with a period (`time_period@0.25`), by the direction of travel
besides (`direction_position_period@1.06`: balls that enter and leave a nut), or more or less by how fast or where the
slider is (`velocity_wave@20`, `position_wave@20`: cogging that a drive holds down at speed), what follows another
variable late (`leg_force_lagged@12`, a first-order lag), yields to it and slips (`leg_force_slipping@0.06`) or wears
off after it changed (`joint_angle_relaxing@12`, the variable less the same lag), functions whose effect lingers
(`velocity_lingering@300`: a nut that its travel heats), what grows towards an end
(`time_position_settling@470`, as what warms does), the time since a circle's run-up began (`time_in_sweep_after@45`,
its angle in degrees), a vector's part along a direction (`acceleration_along@45`, degrees in the x-y plane), and
a function whose sign changes smoothly with the direction of motion, as friction does (`direction_position_turning@0.5`,
transition rate in mm/s or rad/s), and two states, of which one begins where a variable rises to a number and the other
where it falls to a lower one (`leg_force_relay@7.1/14.5`, `position_along@35_relay@-8/11`). What
creeps is a growth towards an end (`growth_settling@470`). Functions of the bar's direction that are others in one
set-up (`bar_angle_by_mount@2`) describe forms only.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import replace

from hexdbb.learned.variable import ELAPSED, IN_MOUNT, LINGERING, OF_MEMORY, TURN, Variable

NUMBERED = "@"
"""In the name of a variable: what follows are the numbers."""
PERIOD_SPLINES = 8
"""Splines of a period that the readings chose: a sine with two harmonics."""
PERIOD_DIGITS = 7
"""Significant digits of a period in a name: of a thousand turns in a test, to a thousandth of a turn."""
SHORT_S, FAST_DIGITS = 0.5, 10
"""Period below which there are more, and their digits: mains hum has a hundred thousand turns in half an hour."""
REPEATING = {
    "time": ("time_s", "s", "time"),
    "position": ("sliders_mm", "mm", "position of the slider"),
    "scale": ("gauge_scale_mm", "mm", "position on the gauge's scale"),
}
"""Columns over which something may repeat with a period that readings choose: column, unit, words."""
INSTANT_S = 1e-4
"""Resolution of instants in names: far below the time between two samples."""
FOLLOWING_SPLINES = 6
"""Splines of what is remembered: springs and rubber bend a little; what they remember is not known in detail."""
LINGERING_SPLINES = 24
"""Splines of a turn, or of a travel, where what they do lingers. More are not asked for: a lag smooths what is finer,
and what readings say of it is their noise."""
PLACES = ("sliders_mm",)
"""Columns that say where something is."""
VELOCITY_SPLINES = 12
"""Splines over the platform's velocity: as many as a slider's has (`variables.VELOCITY`)."""
POSITION_SPLINES = 12
"""Splines over the platform's position: where a foot of a table lifts off, it leans more. What eight of them left of
such a bend was taken for a leg's swing."""
GRAVITY_SPLINES = 8
"""Splines over gravity's share in the platform: as many as over its roll (`variables.ROLL`)."""
BY_MOUNT = "bar_angle_by_mount"
"""What a form's functions of the bar's direction are called: a seat yields, or is out of round, by as few lobes as a
period has harmonics (`PERIOD_SPLINES`)."""
BY_FEED = "time_period_by_feed"
"""What repeats in time, otherwise at each feed, is called."""
WAVES = ("velocity", "position")
"""Variables by which the amplitude of a wave may change."""
WAVE, COSINE, SINE = "wave", "cosine", "sine"
WAVE_SPLINES = 12
"""Splines of a wave's amplitude, over velocity or position: as many as a slider's velocity has, since cogging dies away
within a small part of the range."""
LAGGED, RELAXING, SETTLING, AFTER, ALONG, TURNING = "lagged", "relaxing", "settling", "after", "along", "turning"
CREEP = f"growth_{SETTLING}"
"""What a growth towards an end is called that multiplies no function of another state."""
SLIPPING = "slipping"
RELAY = "relay"
BY_NUMBER = {
    LAGGED: "{} as it was about {:.3g} s before",
    RELAXING: "change of the {} within about {:.3g} s",
    LINGERING: "{}, whose effect lingers for about {:.3g} s",
    SLIPPING: "change of the {}, up to the {:.3g} {unit} at which it slips",
    SETTLING: "{} towards an end within about {:.3g} s",
    AFTER: "{} with its run-up of about {:.3g}°",
    TURNING: "{}, its sign change smoothed over about {:.3g} {unit}",
    RELAY: "two states of the {}: over at {:.3g} {unit}, back at {:.3g} {unit}",
}
"""How a variable may be derived from another one by a number, in words: delayed, high-passed, held by a contact that
yields and slips, growing by the law of a first-order lag in place of evenly, counted from the start of the run-up, with
a smooth change of sign, or in two states that two numbers part."""
FAR = "180"
"""Behind the name of what follows another variable: circles are run up to along so many degrees, four times as far."""
BY_NUMBER |= {f"{how}{FAR}": f"{BY_NUMBER[how]}, with half a circle of run-up" for how in (LAGGED, RELAXING, SLIPPING)}
RATES = {"travel_direction": ("velocity_mm_s", "mm/s"), "slider_joint_direction": ("slider_joint_rate_rad_s", "rad/s")}
"""For each column that holds a direction of motion: the column of the rate whose sign it is, and the rate's unit."""
NUMBER_DIGITS = 4
"""Significant digits of such a number: readings determine it to a few per cent."""
LEVEL_DIGITS = 6
"""The same of the numbers between which a relay keeps its state: a thousandth of a range far from zero."""
DIRECTED = {
    "acceleration": ("carriages_acceleration_mm_s2", "mm/s²", "acceleration of all carriages", FOLLOWING_SPLINES),
    "position": ("position_mm", "mm", "position of the platform", POSITION_SPLINES),
    "velocity": ("platform_velocity_mm_s", "mm/s", "velocity of the platform", VELOCITY_SPLINES),
    "gravity": ("gravity_in_platform", "", "share of gravity in the platform's frame", GRAVITY_SPLINES),
}
"""Vectors of which the part along a direction counts: column, unit, words, splines."""
SIGNED = ("velocity",)
"""Those whose part along a direction has a step where it changes sign: what is loose along one axis only."""
HALF_TURN_DEG = 180.0
"""A direction and its opposite are the same: the spline takes either sign."""


def step(instants_s: Sequence[float]) -> Variable:
    """Return the variable of steps at some instants, rounded down to what its name holds."""
    kept = sorted({math.floor(each / INSTANT_S + 1e-6) * INSTANT_S for each in instants_s})
    names = [f"{each:.4f}".rstrip("0").rstrip(".") for each in kept]
    at = tuple(float(each) for each in names)
    return Variable(f"step@{'/'.join(names)}", "time_s", "s", "time", len(at), instants=at)


def by_mount(mount: float) -> Variable:
    """Return the variable of what turns with the bar in the platform, otherwise with one mount of the cup (from 1)."""
    return Variable(
        f"{BY_MOUNT}{NUMBERED}{mount:.0f}",
        "bar_angle_rad",
        "rad",
        f"angle of the bar in the platform, otherwise in set-up {mount:.0f}",
        PERIOD_SPLINES,
        period=TURN,
        of_forms=True,
        beside=(f"{IN_MOUNT}{mount:.0f}",),
    )


def periodic(column: str, period: float) -> Variable:
    """Return the variable of what repeats with a period of `time` (s), `position` or `scale` (mm)."""
    is_fast = column == "time" and period < SHORT_S
    name = f"{period:.{FAST_DIGITS if is_fast else PERIOD_DIGITS}g}"
    return Variable(f"{column}_period@{name}", *REPEATING[column], PERIOD_SPLINES, period=float(name))


def by_feed(variable: Variable) -> Variable:
    """Return what repeats with a period of time, otherwise at each feed: what shakes at one feed only.

    Frames shake where a motor's ripple meets their own frequency, at one speed and not at another. One function is
    alike at all feeds, one grows with them, and one with their square: of up to three feeds each has its own.
    """
    return replace(
        variable,
        name=variable.name.replace("time_period", BY_FEED),
        words=f"{variable.words}, otherwise at each feed",
        times="feed_ratio_squared",
        beside=("", "feed_ratio"),
    )


def by_direction(variable: Variable) -> Variable:
    """Return what repeats with a period of the slider's position and changes its sign with the direction of travel."""
    return replace(
        variable,
        name=f"direction_{variable.name}",
        words=f"{variable.words}, by direction of travel",
        times="travel_direction",
    )


def wave(variable: Variable, period: float) -> Variable:
    """Return what repeats with a period of the slider's position (mm), by an amplitude that another variable makes.

    Cosine and sine of the phase, each times a function of the variable: a drive holds down at some speeds, and not at
    others, what its motor or its balls do; a gear, or a screw that is worn, waves most in one part of the travel.
    """
    number = f"{period:.{PERIOD_DIGITS}g}"
    column = REPEATING["position"][0]
    cosine, sine = (f"{column}{OF_MEMORY}{each}@{number}" for each in (COSINE, SINE))
    return replace(
        variable,
        name=f"{variable.name}_{WAVE}@{number}",
        words=f"{variable.words}, times a wave over {float(number):.4g} mm of its position",
        count=WAVE_SPLINES,
        times=sine,
        beside=(cosine,),
        signed=False,
    )


def period_of_wave(times: str) -> float | None:
    """Return the period of a wave that multiplies functions; None where what multiplies them is none."""
    how, _, number = times.partition(OF_MEMORY)[2].partition("@")
    return float(number) if how in (COSINE, SINE) else None


def following(variable: Variable, how: str, constant: float) -> Variable:
    """Return the variable of what follows another one.

    Parameters
    ----------
    variable : Variable
        For `TURNING` one that a direction of `RATES` multiplies, or with a step where its column changes sign.
    how : str
        `LAGGED`, `RELAXING`, `SLIPPING`, `SETTLING`, `AFTER` or `TURNING`.
    constant : float
        s; degrees for `AFTER`; for `SLIPPING` how far it yields, in the variable's unit; for `TURNING` the transition
        rate, in the unit of the rate.
    """
    number = f"{constant:.{NUMBER_DIGITS}g}"
    if how == TURNING:
        rate, unit = (variable.column, variable.unit) if variable.signed else RATES[variable.times]
        return replace(
            variable,
            name=f"{variable.name}_{how}@{number}",
            times="" if variable.signed else f"{rate}{OF_MEMORY}{how}@{number}",
            turns_within=float(number) if variable.signed else 0.0,
            words=BY_NUMBER[how].format(variable.words, float(number), unit=unit),
        )
    if how == SETTLING:
        return replace(
            variable,
            name=f"{variable.name}_{how}@{number}",
            times=f"{variable.times}{OF_MEMORY}{how}@{number}",
            words=BY_NUMBER[how].format(variable.words, float(number)),
        )
    return replace(
        variable,
        name=f"{variable.name}_{how}@{number}",
        column=f"{variable.column}{OF_MEMORY}{how}@{number}",
        words=BY_NUMBER[how].format(variable.words, float(number), unit=variable.unit).replace("  ", " "),
        count=variable.count if how == AFTER else _splines_of_memory(variable, how),
        signed=False,
        is_coarse=how == LINGERING,
    )


def _splines_of_memory(variable: Variable, how: str) -> int:
    """Return how many splines a variable has that remembers; many where what lingers is warmed at one place.

    What is warmed by speed has a bend at rest: six splines over both directions left a fifth of what lasts two feeds.
    """
    if how == LINGERING and variable.signed:
        return VELOCITY_SPLINES
    is_place = variable.period or (how == LINGERING and variable.column in PLACES)
    return LINGERING_SPLINES if is_place else FOLLOWING_SPLINES


def two_states(variable: Variable, low: float, high: float) -> Variable:
    """Return the variable of what snaps over where another one rises to a number, and back where it falls to a lower.

    Its one coefficient is half of the distance of the two states.
    """
    numbers = "/".join(f"{each:.{LEVEL_DIGITS}g}" for each in (low, high))
    return replace(
        variable,
        name=f"{variable.name}_{RELAY}@{numbers}",
        column=f"{variable.column}{OF_MEMORY}{RELAY}@{numbers}",
        unit="",
        words=BY_NUMBER[RELAY].format(variable.words, high, low, unit=variable.unit).replace(" ,", ",").rstrip(),
        count=1,
        times="",
        signed=False,
        is_log=False,
    )


def is_relay(variable: Variable) -> bool:
    """Whether a variable has two states."""
    return f"{OF_MEMORY}{RELAY}@" in variable.column


def creeps(variable: Variable) -> bool:
    """Whether a variable is nothing but a growth with time towards an end."""
    return variable.name.startswith(f"{CREEP}@")


def creep(constant_s: float) -> Variable:
    """Return the variable of what creeps towards an end, by the law of a first-order lag.

    Evenly nothing creeps: a growth in proportion to time is a gauge's drift, of which no cup is to take the place.
    """
    number = f"{constant_s:.{NUMBER_DIGITS}g}"
    words = BY_NUMBER[SETTLING].format("growth with time", float(number))
    return Variable(f"{CREEP}@{number}", "", "", words, times=f"{ELAPSED}{OF_MEMORY}{SETTLING}@{number}")


def turns_with(variable: Variable) -> str | None:
    """Return the column at whose zero a variable's functions change sign abruptly; None if they do not."""
    if variable.turns_within or is_directed(variable):
        return None
    return variable.column if variable.signed else RATES[variable.times][0] if variable.times in RATES else None


def turning(variable: Variable, rate: float) -> Variable:
    """Return the same variable with its change of sign smoothed over a transition rate (mm/s, rad/s)."""
    return following(variable, TURNING, rate)


def at_once(times: str) -> str:
    """Return the direction column that a smoothed one replaces; other columns unchanged."""
    if not turns_gradually(times):
        return times
    return next(direction for direction, (rate, _) in RATES.items() if times.startswith(f"{rate}{OF_MEMORY}"))


def is_directed(variable: Variable) -> bool:
    """Whether a variable is a vector's part along a direction that the readings chose."""
    return f"{OF_MEMORY}{ALONG}@" in variable.column and not is_relay(variable)


def turns_gradually(times: str) -> bool:
    """Whether a multiplying column is a direction whose change of sign is smoothed."""
    return rate_of(times) is not None


def rate_of(times: str) -> str | None:
    """Return the rate at whose zero a multiplying column changes its sign smoothly; None where it does not."""
    rate, _, how = times.partition(OF_MEMORY)
    return rate if how.startswith(f"{TURNING}@") else None


def transition_rate(times: str) -> float:
    """Return over what rate such a column changes its sign, in the rate's unit."""
    return float(times.partition("@")[2])


def along(vector: str, direction_deg: float) -> Variable:
    """Return the variable of a vector's part along a direction in its x-y plane; `DIRECTED` names the vector."""
    column, unit, words, count = DIRECTED[vector]
    number = f"{direction_deg % HALF_TURN_DEG or HALF_TURN_DEG:.{NUMBER_DIGITS}g}"
    return Variable(
        f"{vector}_{ALONG}@{number}",
        f"{column}{OF_MEMORY}{ALONG}@{number}",
        unit,
        f"{words} along {float(number):.3g}° in the x-y plane",
        count,
        signed=vector in SIGNED,
    )


def has_chosen_number(variable: Variable) -> bool:
    """Whether its name carries a number that readings chose, and that can be moved a little: a period, a constant."""
    return "@" in variable.name and not variable.instants and not is_relay(variable)


def has_chosen_period(variable: Variable) -> bool:
    """Whether that number is a period; what turns with the screw may have another."""
    kinds = (*(f"{each}_period" for each in REPEATING), BY_FEED, *(f"{each}_{WAVE}" for each in WAVES))
    return any(variable.name.removeprefix("direction_").startswith(f"{each}{NUMBERED}") for each in kinds)


def repeats_over(variable: Variable) -> str:
    """Return the column over which something repeats with a period that readings chose."""
    is_wave = period_of_wave(variable.times) is not None
    return variable.times.partition(OF_MEMORY)[0] if is_wave else variable.column


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
    return following(known[of], how, values[0])
