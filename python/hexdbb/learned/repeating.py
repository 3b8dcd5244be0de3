"""Variables of what repeats: in time, along a slider's travel, over the gauge's scale, with a period readings chose.

By the direction of travel besides (`direction_position_period@1.06`: balls that enter and leave a nut), otherwise at
each feed, or more or less by how fast or where the slider is (`velocity_wave@20`, `position_wave@20`: cogging that a
drive holds down at speed). Functions of the bar's direction that are others in one set-up (`bar_angle_by_mount@2`)
describe forms only.
"""

from __future__ import annotations

from dataclasses import replace

from hexdbb.learned.variable import IN_MOUNT, NUMBERED, OF_MEMORY, TURN, Variable

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


def swinging(variable: Variable, name: str, of: str, phase: tuple[str, str], count: int) -> Variable:
    """Return what swings by an amplitude that a variable makes: cosine and sine of a phase, each times a function.

    Parameters
    ----------
    variable : Variable
    name : str
    of : str
        Of what it is a wave, in words.
    phase : tuple of str
        Columns of cosine and sine.
    count : int
        Splines of either function.
    """
    cosine, sine = phase
    words = f"{variable.words}, times a wave {of}"
    return replace(variable, name=name, words=words, count=count, times=sine, beside=(cosine,), signed=False)


def wave(variable: Variable, period: float) -> Variable:
    """Return what repeats with a period of the slider's position (mm), by an amplitude that another variable makes.

    A drive holds down at some speeds, and not at others, what its motor or its balls do; a gear, or a screw that is
    worn, waves most in one part of the travel.
    """
    number = f"{period:.{PERIOD_DIGITS}g}"
    column = REPEATING["position"][0]
    phase = f"{column}{OF_MEMORY}{COSINE}{NUMBERED}{number}", f"{column}{OF_MEMORY}{SINE}{NUMBERED}{number}"
    of = f"over {float(number):.4g} mm of its position"
    return swinging(variable, f"{variable.name}_{WAVE}{NUMBERED}{number}", of, phase, WAVE_SPLINES)


def period_of_wave(times: str) -> float | None:
    """Return the period of a wave that multiplies functions; None where what multiplies them is none."""
    how, _, number = times.partition(OF_MEMORY)[2].partition("@")
    return float(number) if how in (COSINE, SINE) else None


def has_chosen_period(variable: Variable) -> bool:
    """Whether that number is a period; what turns with the screw may have another."""
    kinds = (*(f"{each}_period" for each in REPEATING), BY_FEED, *(f"{each}_{WAVE}" for each in WAVES))
    return any(variable.name.removeprefix("direction_").startswith(f"{each}{NUMBERED}") for each in kinds)


def repeats_over(variable: Variable) -> str:
    """Return the column over which something repeats with a period that readings chose."""
    is_wave = period_of_wave(variable.times) is not None
    return variable.times.partition(OF_MEMORY)[0] if is_wave else variable.column
