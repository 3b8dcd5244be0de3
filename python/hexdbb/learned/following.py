"""Variables that follow another one by a number that readings chose.

Late (`leg_force_lagged@12`, a first-order lag), up to where it slips (`leg_force_slipping@0.06`), wearing off after it
changed (`joint_angle_relaxing@12`, the variable less the same lag), lingering (`velocity_lingering@300`: a nut that its
travel heats), growing towards an end (`time_position_settling@470`, as what warms does; what only creeps is
`growth_settling@470`), in proportion to how warm its own motion has made what it moves along
(`position_heated@500`), counted from a circle's run-up (`time_in_sweep_after@45`, its angle in degrees), with a sign
that changes smoothly (`direction_position_turning@0.5`, transition rate in mm/s or rad/s), or in two states, of which
one begins where a variable rises to a number and the other where it falls to a lower one
(`leg_force_relay@7.1/14.5`, `position_along@35_relay@-8/11`).
"""

from __future__ import annotations

from dataclasses import replace

from hexdbb.learned.variable import ELAPSED, LINGERING, OF_MEMORY, Variable

FOLLOWING_SPLINES = 6
"""Splines of what is remembered: springs and rubber bend a little; what they remember is not known in detail."""
LINGERING_SPLINES = 24
"""Splines of a turn, or of a travel, where what they do lingers. More are not asked for: a lag smooths what is finer,
and what readings say of it is their noise."""
VELOCITY_SPLINES = 12
"""Splines over the platform's velocity: as many as a slider's has (`variables.VELOCITY`)."""
PLACES = ("sliders_mm",)
"""Columns that say where something is."""
LAGGED, RELAXING, SETTLING, AFTER, TURNING = "lagged", "relaxing", "settling", "after", "turning"
HEATED = "heated"
HEATED_SPLINES = 6
"""Splines over the place of what is heated: a beam or a screw between its bearings bends once, as what grows does."""
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
    HEATED: "{}, in proportion to the heat of its motion within about {:.3g} s",
    TURNING: "{}, its sign change smoothed over about {:.3g} {unit}",
    RELAY: "two states of the {}: over at {:.3g} {unit}, back at {:.3g} {unit}",
}
"""How a variable may be derived from another one by a number, in words: delayed, high-passed, held by a contact that
yields and slips, growing by the law of a first-order lag in place of evenly, counted from the start of the run-up, in
proportion to the heat of its own motion, with a smooth change of sign, or in two states that two numbers part."""
FAR = "180"
"""Behind the name of what follows another variable: circles are run up to along so many degrees, four times as far."""
BY_NUMBER |= {f"{how}{FAR}": f"{BY_NUMBER[how]}, with half a circle of run-up" for how in (LAGGED, RELAXING, SLIPPING)}
RATES = {"travel_direction": ("velocity_mm_s", "mm/s"), "slider_joint_direction": ("slider_joint_rate_rad_s", "rad/s")}
"""For each column that holds a direction of motion: the column of the rate whose sign it is, and the rate's unit."""
SPEED_OF = {"sliders_mm": "velocity_mm_s"}
"""For each column of places: that of the velocity whose friction heats what lies there."""
NUMBER_DIGITS = 4
"""Significant digits of such a number: readings determine it to a few per cent."""
LEVEL_DIGITS = 6
"""The same of the numbers between which a relay keeps its state: a thousandth of a range far from zero."""


def following(variable: Variable, how: str, constant: float) -> Variable:
    """Return the variable of what follows another one.

    Parameters
    ----------
    variable : Variable
        For `TURNING` one that a direction of `RATES` multiplies, or with a step where its column changes sign.
    how : str
        `LAGGED`, `RELAXING`, `SLIPPING`, `SETTLING`, `HEATED`, `AFTER` or `TURNING`.
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
    if how in (HEATED, SETTLING):
        times, count = (
            (SPEED_OF[variable.column], HEATED_SPLINES) if how == HEATED else (variable.times, variable.count)
        )
        return replace(
            variable,
            name=f"{variable.name}_{how}@{number}",
            times=f"{times}{OF_MEMORY}{how}@{number}",
            words=BY_NUMBER[how].format(variable.words, float(number)),
            count=count,
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


def may_be_heated(variable: Variable) -> bool:
    """Whether a variable is a place alone, along which something moves."""
    return variable.column in SPEED_OF and not variable.times and not variable.period


def is_heated(times: str) -> bool:
    """Whether what multiplies a function is the heat of a motion."""
    return times.partition(OF_MEMORY)[2].startswith(f"{HEATED}@")


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
