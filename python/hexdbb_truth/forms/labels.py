"""What is true of a fault, and what says the same on these circles: the ground truth a verdict is judged by.

Ports: as in `ports`; `guideway` is the joints of both sliders across the guideway.
Variables: `position` (of the slider), `direction` (of travel, with its hysteresis), `since_reversal`, `velocity`,
`acceleration`, `time`, `time_in_run` (since a run began), `feed`, `joint_angle`, `joint_turning`, `inclination` (of the
leg), `leg_force`, `angle` (of the bar), `tilt` and `yaw` (of the platform), `deflection`, `constant`; one followed by
`_relaxing` is how far it is ahead of what lags behind it.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Equivalent:
    """Another place and variable that explains the same readings, and why it does."""

    port: str
    variable: str
    elements: tuple[int, ...] | None
    """From 1; None: any."""
    why: str
    effect: str | None = None
    """A catalogue effect that is it."""


SAME_LEG = "one slider moves one leg: along the guideway or along the leg the platform feels nearly the same"


def leg_too(k: int, variable: str, effect: str | None = None) -> Equivalent:
    """Return the leg of a slider (from 0) as a place that explains the same."""
    return Equivalent("leg", variable, (k + 1,), SAME_LEG, effect)


def slider_too(k: int, variable: str, effect: str | None = None) -> Equivalent:
    """Return the slider of a leg (from 0) as a place that explains the same."""
    return Equivalent("slider", variable, (k + 1,), SAME_LEG, effect)


@dataclass(frozen=True)
class Label:
    """The truth about one fault.

    Attributes
    ----------
    kind : str
    catalogued : bool
        Whether the catalogue has an effect of this name.
    port : str
    elements : tuple of int
        From 1; () for the whole machine (all elements alike, or a port of one).
    variables : tuple of str
        That the fault depends on; any of them counts where several are given.
    equivalents : tuple of Equivalent
    """

    kind: str
    catalogued: bool
    port: str
    elements: tuple[int, ...]
    variables: tuple[str, ...]
    equivalents: tuple[Equivalent, ...] = ()


VARIABLES: dict[str, tuple[str, ...]] = {
    "backlash": ("direction",),
    "reversal_spike": ("since_reversal",),
    "pitch_cyclic": ("position",),
    "lead_error": ("position",),
    "straightness": ("position",),
    "servo_lag": ("velocity",),
    "leg_thermal": ("time",),
    "screw_thermal": ("time", "position"),
    "gravity_sag": ("leg_force",),
    "joint_offset": ("constant", "joint_angle"),
    "joint_friction": ("joint_turning",),
    "bar_drift": ("time",),
    "bar_gain": ("deflection",),
    "sample_delay": ("velocity",),
    "ball_eccentricity": ("time",),
}
"""What each catalogue effect depends on."""


def _neighbour(element: int) -> int:
    """Return the other slider or leg of a pair, from 1."""
    return element - 1 if element % 2 == 0 else element + 1


def equivalents(kind: str, elements: tuple[int, ...]) -> tuple[Equivalent, ...]:
    """Return what is to first order the same as a catalogue effect at these elements (from 1)."""
    if kind == "joint_offset":
        other = (_neighbour(elements[0]),)
        return (
            Equivalent(
                "platform_joint", "constant", other, "a rigid motion of the pair's joint is platform_side's", kind
            ),
            Equivalent("leg", "joint_angle", (elements[0], *other), "the offset's part along the leg turns with it"),
        )
    if kind == "joint_friction":
        return (Equivalent("slider", "direction", elements, "a slider joint turns over where its slider does"),)
    if kind in ("backlash", "reversal_spike"):
        return (Equivalent("leg", "joint_turning", elements, "a slider joint turns over where its slider does"),)
    if kind == "servo_lag":
        return (
            Equivalent("slider", "direction", elements, "where a slider hardly changes its speed between reversals"),
        )
    if kind == "sample_delay":
        return (
            Equivalent("slider", "velocity", (1, 2, 3, 4, 5, 6), "all sliders later by one time", "servo_lag"),
            Equivalent("reading", "direction", None, "the reading's derivative changes sign with the direction"),
            Equivalent("reading", "deflection_relaxing", None, "what lags by a short time is late by that time"),
        )
    if kind == "leg_thermal":
        return (Equivalent("cup", "time", None, "legs that grow alike lift the platform: the cup sinks"),)
    if kind == "ball_eccentricity":
        return (
            Equivalent("ball", "angle", None, "per fixing, the offset's reading is a wave of the bar's direction"),
            Equivalent("platform_joint", "time", None, "the platform's joints moved against the ball"),
        )
    if kind == "bar_gain":
        return (Equivalent("reading", "angle", None, "the deflection is a function of circle and angle"),)
    if kind == "straightness":
        return (
            Equivalent("guideway", "position", elements, "lateral for vertical, where the circles see their sum only"),
        )
    return ()
