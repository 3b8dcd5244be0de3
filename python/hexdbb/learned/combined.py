"""Variables made of others: a product, one function each way, the neighbour's, what remembers, those of each drive."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from hexdbb.learned import variables as v
from hexdbb.learned.following import FAR, LAGGED, RELAXING, SLIPPING, following, is_heated
from hexdbb.learned.variable import ELAPSED, Variable, is_growing

SPLINES = 6
"""Splines of a product: what multiplies sets most of its form already."""
CONSTANTS_S = (2.0, 6.0, 20.0, 60.0)
"""Time constants of what remembers, at first: a factor of three apart each contains half of its neighbour; the readings
then move it. Shorter ones follow at once at usual feeds, longer ones are functions of time."""
SLIPS = {
    **dict.fromkeys(("leg_force", "drive_load", "carriage_load"), (0.02, 0.06)),
    "joint_angle": (0.03, 0.12),
    "inclination": (0.01, 0.03),
    **dict.fromkeys(("swing_angle", "platform_joint_angle"), (0.01, 0.04)),
}
"""How far a contact yields before it slips, at first, by the variable that strains it: loads per vertical load change
by 0.1 to 0.2 in a circle, joints turn by 0.3 to 0.6 rad, legs swing and incline by 0.1 to 0.2. The readings then move
it."""
LONG_S = (6.0, 20.0)
"""The same where circles are run up to from afar: what is shorter forgets the run-up, longer is seen in the mean."""
FACTORS = {
    "velocity": ("velocity_mm_s", "velocity"),
    "acceleration": ("acceleration_mm_s2", "acceleration"),
    "leg_force": ("leg_force", "force of the leg"),
    "direction": ("travel_direction", "direction of travel"),
    "joint_direction": ("slider_joint_direction", "sense in which the slider's joint turns"),
    "deflection": ("deflection_mm", "deflection of the gauge"),
    "time": (ELAPSED, "time"),
    "warming": ("warming_k", "warming"),
    "speed": ("speed_mm_s", "speed of the platform"),
    "circle_direction": ("direction", "direction of the circle"),
    "deflection_direction": ("deflection_direction", "sense in which the gauge moves"),
    "drive_load": ("drive_load", "force along the guideway"),
    "joint_rate": ("slider_joint_rate_rad_s", "turning rate of the slider's joint"),
    "joint_angle": ("slider_joint_angle_rad", "angle of the slider's joint"),
}
"""What may multiply a function: name, column and words."""
FACTORS |= {
    f"neighbour_{name}": (f"neighbour_{column}", f"{words} of the other slider on the guideway")
    for name, (column, words) in FACTORS.items()
    if name in ("velocity", "acceleration", "direction")
}


def is_slow(variable: Variable) -> bool:
    """Whether a variable is a product with what changes over a whole test: time or warmth."""
    return is_growing(variable.times) or variable.times == FACTORS["warming"][0] or is_heated(variable.times)


def product(factor: str, variable: Variable) -> Variable:
    """Return the functions of a variable times one of `FACTORS`: `velocity_leg_force`."""
    column, words = FACTORS[factor]
    return replace(
        variable,
        name=f"{factor}_{variable.name}",
        words=f"{variable.words}, times the {words}",
        count=v.SWINGS if variable == v.TIME else variable.count if variable.period else SPLINES,
        times=column,
        signed=False,
        of_forms=False,
        parts=(factor, variable.name),
    )


def each_way(variable: Variable, by: str, words: str) -> Variable:
    """Return a function of its own for either direction: what catches one way only is neither even nor odd.

    Parameters
    ----------
    variable : Variable
    by : str
        Column of the direction's sign.
    words : str
        What that direction is called.
    """
    return replace(
        variable,
        name=f"{variable.name}_each_way",
        words=f"{variable.words}, each {words} by itself",
        times=by,
        parts=(variable.name,),
        beside=("",),
    )


def neighbour(variable: Variable) -> Variable:
    """Return the variable of the other slider, or leg, on the guideway."""
    words = variable.words.replace("of the slider", "of the other slider on the guideway")
    words = words.replace("of the leg", "of the other leg of the pair")
    return replace(variable, name=f"neighbour_{variable.name}", words=words, of_neighbour=True)


def remembered(*variables: Variable) -> Iterator[Variable]:
    """Yield what each becomes that follows late, relaxes or slips, by every time and distance that is tried first."""
    for each in variables:
        for how in (LAGGED, RELAXING):
            yield from (following(each, how, constant_s) for constant_s in CONSTANTS_S)
            yield from (following(each, f"{how}{FAR}", constant_s) for constant_s in LONG_S)
        yield from slipping(each)


def slipping(variable: Variable) -> Iterator[Variable]:
    """Yield what a variable becomes that strains a contact until it slips, with run-ups of either length."""
    for how in (SLIPPING, f"{SLIPPING}{FAR}"):
        yield from (following(variable, how, most) for most in SLIPS.get(variable.name, ()))


def of_drives(variables: Iterable[Variable]) -> Iterator[Variable]:
    """Yield each variable of each slider and its leg, whatever is pushed."""
    for variable in variables:
        for slider in range(1, 7):
            yield replace(
                variable,
                name=f"slider_{slider}_{variable.name}",
                of_element=slider,
                words=_of_drive(variable.words, slider),
            )


def _of_drive(words: str, slider: int) -> str:
    """Return a variable's words with the slider or the leg that it belongs to."""
    found = words.replace("since the reversal", f"since the reversal of slider {slider}")
    for whose in ("slider", "leg"):
        found = found.replace(f"the {whose}", f"{whose} {slider}")
    return found if found != words else f"{words} of slider {slider}"
