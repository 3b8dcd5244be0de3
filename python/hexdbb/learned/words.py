"""A fitted function in words: a bump, a sine, a step, a line, a drift; else between what values it varies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hexdbb.learned.following import is_heated
from hexdbb.learned.forms import Fit, Floats, fits
from hexdbb.learned.repeating import period_of_wave
from hexdbb.learned.signs import turns_gradually
from hexdbb.learned.tables import Curve
from hexdbb.learned.variable import BENT, ELAPSED, OF_MEMORY

ENOUGH = 0.9
"""Part of a function's variation that a form must explain to be named: what is left is then below a third of it."""
DEAD_BAND_ENOUGH = 0.995
"""The same of a dead band: a parabola, a cubic and an exponential function, which have none, are explained to 0.989."""
MUCH_BETTER = 0.5
"""A more complicated form is named where it leaves less than this part of what the simpler leaves."""
CONSTANT_TO = 0.05
"""Part of the change on one side of a dead band below which the other side is called constant: scatter of a hundredth
of the function makes one of 0.01."""
NARROW = 0.02
"""Part of the variable's range below which a dead band is called a change of slope: splines a twelfth of the range
apart do not show so narrow a one."""
CERTAIN = 2.0
"""Standard deviations of the band that a function must leave zero by, somewhere, to be told from it."""
UM_PER_MM = 1e3
S_PER_H = 3600.0
SHOWN = {"rad": ("deg", 180.0 / np.pi), "rad/s": ("deg/s", 180.0 / np.pi)}
"""Unit of a variable to that in which people read it, with the factor."""
TIMES = {
    "": "",
    "travel_direction": ", its sign turning over with the direction of travel",
    "slider_joint_direction": ", its sign turning over with the sense in which the joint turns",
    "direction": ", its sign turning over with the direction of the circle",
    ELAPSED: ", growing with time",
    BENT: ", more and then less again with time",
    "velocity_mm_s": ", for each mm/s of velocity",
    "acceleration_mm_s2": ", for each mm/s² of acceleration",
    "leg_force": ", for each unit of the leg's force",
    "slider_joint_rate_rad_s": ", for each rad/s of the joint's turning",
    "warming_k": ", for each K of warming",
    "feed_ratio": ", for each 50 mm/s of feed",
    "feed_ratio_squared": ", for the square of each 50 mm/s of feed",
    "speed_mm_s": ", for each mm/s of the platform's speed",
    "carriages_acceleration_mm_s2": ", for each mm/s² of the carriages' acceleration",
    "course": ", along the direction in which the platform moves",
    "course_x": ", times the part along x of the direction in which the platform moves",
    "course_y": ", times the part along y of the direction in which the platform moves",
    "course_in_platform": ", along the direction in which the platform moves",
    "downhill_in_platform": ", towards the platform's lower side",
    "deflection_mm": ", for each mm of deflection",
    "deflection_direction": ", its sign turning over with the sense in which the gauge moves",
    "deflection_turning_mm": ", for each mm of deflection, its sign turning over with the gauge's sense",
    "drive_load": ", for each unit of force along the guideway",
    "leg_force_direction": ", its sign turning over with the sense in which the leg's force changes",
    "drive_load_direction": ", its sign turning over with the sense in which the force along the guideway changes",
    "carriage_load_direction": ", its sign turning over with the sense in which the force across the guideway changes",
    "screw_cos": ", times the cosine of the screw's turn",
    "screw_sin": ", times the sine of the screw's turn",
    "leg_tilt_in_platform": ", times the leg's tilt in the platform",
    "leg_tilt_in_platform_squared": ", times the square of the leg's tilt in the platform",
    "leg_tilt_in_base": ", times the leg's tilt",
    "leg_tilt_in_base_squared": ", times the square of the leg's tilt",
    "slider_joint_angle_rad": ", for each rad of the joint's angle",
    "neighbour_velocity_mm_s": ", for each mm/s of the other slider's velocity",
    "neighbour_acceleration_mm_s2": ", for each mm/s² of the other slider's acceleration",
    "neighbour_travel_direction": ", its sign turning over with the other slider's direction of travel",
}
GRADUAL = ", its sign changing smoothly with the direction of motion"


@dataclass(frozen=True)
class Form:
    """What a function looks like.

    Attributes
    ----------
    kind : str
        `nothing`, `constant`, `two states`, `linear`, `drift`, `step`, `sine`, `bump`,
        `dead band`; `varies` where none of these.
    fit : Fit or None
        The form in numbers, variable in its own unit, function in mm; None for `nothing`, `constant`,
        `two states` and `varies`.
    text : str
        In words.
    """

    kind: str
    fit: Fit | None
    text: str


def describe(curve: Curve, period: float = 0.0) -> Form:
    """Describe a function.

    Parameters
    ----------
    curve : Curve
    period : float
        Of its variable; 0 where it is not periodic.
    """
    turned = _turned(curve.times)
    values = curve.value_mm - (np.median(curve.value_mm) if len(curve.at) > 2 and not curve.times else 0.0)
    if not np.any(np.abs(values) > CERTAIN * np.nan_to_num(curve.sigma_mm)):
        return Form("nothing", None, "not distinguishable from zero")
    if len(curve.at) < 2:
        return Form("constant", None, f"{curve.value_mm[0] * UM_PER_MM:.2f} µm{turned}")
    if curve.has_states:
        apart_um = UM_PER_MM * float(np.ptp(curve.value_mm))
        return Form("two states", None, f"{apart_um:.3g} µm from one to the other")
    if len(curve.at) == 2:
        fit = next(fits(curve.at, curve.value_mm, np.ones(2)))
        return Form("linear", fit, _words(fit, curve) + turned)
    weights = _weights(curve)
    best: Fit | None = None
    for fit in fits(curve.at, curve.value_mm, weights, period):
        if fit.explained >= (DEAD_BAND_ENOUGH if fit.kind == "dead band" else ENOUGH) and (
            best is None or 1.0 - fit.explained < MUCH_BETTER * (1.0 - best.explained) - 1e-12
        ):
            best = fit
    if best is None or _is_too_small(best, curve):
        low, high = curve.value_mm.min() * UM_PER_MM, curve.value_mm.max() * UM_PER_MM
        return Form("varies", None, f"varies between {low:.1f} and {high:.1f} µm{turned}")
    kind = "drift" if best.kind == "linear" and curve.column == "time_s" else best.kind
    return Form(kind, best, _words(best, curve) + turned)


def _turned(times: str) -> str:
    """Return what multiplies a function, in words."""
    if turns_gradually(times):
        return GRADUAL
    if is_heated(times):
        return ", for each mm/s of mean speed, as its heat lasts"
    column, _, how = times.partition(OF_MEMORY)
    if (period := period_of_wave(times)) is not None:
        return f", times the {how.partition('@')[0]} of its phase in {period:.4g} mm"
    return TIMES.get(column, "")


def shown_places(curve: Curve) -> tuple[str, Floats]:
    """Return the unit in which people read a function's variable, and its places in it."""
    unit, factor = SHOWN.get(curve.unit, (curve.unit, 1.0))
    return unit, curve.at * factor


def _weights(curve: Curve) -> Floats:
    """Return weights of the points: the length of variable each stands for, none where no sample is near."""
    lengths: Floats = np.gradient(curve.at)
    seen = np.nan_to_num(curve.samples, nan=1.0) > 0.0
    weights = np.where(seen, lengths, 0.0)
    return weights if np.count_nonzero(weights) > 5 else lengths


def _is_too_small(fit: Fit, curve: Curve) -> bool:
    """Check whether a form varies no more than the function's band."""
    size = float(np.ptp(fit.at(curve.at)))
    return size < CERTAIN * float(np.nanmedian(np.nan_to_num(curve.sigma_mm)))


def _words(fit: Fit, curve: Curve) -> str:
    unit, factor = SHOWN.get(curve.unit, (curve.unit, 1.0))
    size_um = UM_PER_MM * fit.coefficients
    if fit.kind == "linear":
        if curve.column == "time_s":
            return f"a drift of {size_um[0] * S_PER_H:.4g} µm/h"
        return f"linear, {size_um[0] / factor:.3g} µm per {unit or 'unit'}"
    if fit.kind == "step":
        return f"a step of {2.0 * size_um[0]:.3g} µm with the sign of the {curve.variable}"
    if fit.kind == "sine":
        amplitude = float(np.hypot(*size_um))
        return f"a sine of period {_with(unit, fit.shapes[0] * factor, 4)} and amplitude {amplitude:.3g} µm"
    if fit.kind == "dead band":
        return _dead_band(np.cumsum(fit.shapes) * factor, size_um / factor, unit, curve.at * factor)
    centre, width = fit.shapes * factor
    name = "bump" if size_um[0] > 0.0 else "dip"
    at, wide = _with(unit, centre, 4), _with(unit, width, 3)
    return f"a {name} of {abs(size_um[0]):.3g} µm at {at}, {wide} wide at half height"


def _dead_band(ends: Floats, slopes_um: Floats, unit: str, at: Floats) -> str:
    """Return the words for a function that is constant between two values of its variable and linear outside them."""
    low, high = (_with(unit, each, 3) for each in ends)
    below, above = (f"{each:.3g} µm per {unit or 'unit'}" for each in slopes_um)
    changes = np.abs(slopes_um) * [ends[0] - at.min(), at.max() - ends[1]]
    if changes[0] < CONSTANT_TO * changes[1]:
        return f"constant up to {high}, then {above}"
    if changes[1] < CONSTANT_TO * changes[0]:
        return f"{below} up to {low}, then constant"
    if ends[1] - ends[0] < NARROW * np.ptp(at):
        return f"{below} up to {low}, then {above}"
    return f"constant from {low} to {high}; {below} below, {above} above"


def _with(unit: str, number: float, digits: int) -> str:
    return f"{number:.{digits}g} {unit}".rstrip()
