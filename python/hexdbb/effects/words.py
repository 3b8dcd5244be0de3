"""Effects in the words of whoever fits the machine: ``slider 4 has 15.0 ± 0.1 µm of play between drive and carriage``.

An effect without words of its own is told by its physics' first sentence and its values.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby

from hexdbb import _core
from hexdbb.model import Size
from hexdbb.units import readable_unit

CLAUSES = {
    "backlash": "{who} has {play} of play between drive and carriage",
    "reversal_spike": "{who} falls {height} behind after each reversal, then catches up",
    "pitch_cyclic": "the screw of {who} has a pitch error that repeats with each turn",
    "lead_error": "the screw of {who} has a lead too long by {lead}",
    "straightness": "{who} is bowed by {lateral} outward and {vertical} up",
    "servo_lag": "{who} lags {lag} behind its drive's encoder",
    "leg_thermal": "the legs {grow} during the test",
    "screw_thermal": "the screw of {who} {grow}s during the test",
    "gravity_sag": "the legs give by {compliance} under the platform's weight",
    "joint_offset": "the ball centre of {who} misses its joint centre by {x}, {y} and {z}",
    "joint_friction": "friction in the joints of {who} changes its length by {deflection} against their turning",
    "bar_drift": "the gauge drifts by {rate}",
    "bar_gain": "the gauge's scale is off by {gain}",
    "sample_delay": "the gauge is read {delay} later than the encoders",
    "bar_length": "the bar is {longer} {sense} than its calibration says",
    "ball_rotation": "the ball's holder, or the triangle of joints, is turned by {about_x}, {about_y} and {about_z}",
    "ball_eccentricity": "the bar's ball sits otherwise in set-up {element}: by {x}, {y} and {z}",
}
"""Clause on one element; `who` is the element, `grow` (or shrink) and `sense` (longer or shorter) follow the sign, the
others are values with uncertainty."""
MAX_CLAUSES = 2
"""Elements told one by one; of more, which they are, the largest and the smallest: a sentence remains one."""


def effect_clause(info: _core.EffectInfo, sizes: Sequence[Size]) -> str:
    """Return an effect with its values as a clause, lower case, without a full stop.

    Parameters
    ----------
    info : EffectInfo
    sizes : sequence of Size
        Values of the elements that are meant.
    """
    elements = [(name, list(each)) for name, each in groupby(sizes, key=lambda size: size.element)]
    if len(elements) > MAX_CLAUSES:
        return _of_several(info, elements)
    return " and ".join(_clause(info, element, own) for element, own in elements)


def _of_several(info: _core.EffectInfo, elements: Sequence[tuple[str, Sequence[Size]]]) -> str:
    """Return an effect that several elements have: where it is largest, and what it is where it is smallest."""
    kind, place = info.element_kind, _telling(elements)
    ranked = sorted(elements, key=lambda each: -abs(each[1][place].value))
    (largest, most), (element, least) = ranked[0], ranked[-1]
    *names, last = [name for name, _ in elements]
    some = f"{kind}s {', '.join(names)} and {last}"
    whose = f"all {len(elements)} {kind}s" if len(elements) == len(info.elements) else some
    told = f"{whose}: {_clause(info, largest, most)}"
    if f"{{{least[place].name}}}" not in CLAUSES.get(info.name, ""):
        return f"{told} most, that of {kind} {element} least"
    return f"{told}, down to {size_words(least[place])} of {kind} {element}"


def _telling(elements: Sequence[tuple[str, Sequence[Size]]]) -> int:
    """Return the index of the first value that is not zero at all elements (without a temperature, `per_kelvin` is)."""
    return next((k for k in range(len(elements[0][1])) if any(sizes[k].value for _, sizes in elements)), 0)


def _clause(info: _core.EffectInfo, element: str, sizes: Sequence[Size]) -> str:
    who = "the machine" if info.element_kind == "machine" else f"{info.element_kind} {element}"
    values = {size.name: size_words(size) for size in sizes}
    if (clause := CLAUSES.get(info.name)) is not None:
        is_less = sizes[_telling([(element, sizes)])].value < 0.0
        grow, sense = ("shrink", "shorter") if is_less else ("grow", "longer")
        if "{sense}" in clause:  # which says the sign
            values = {size.name: size_words(replace(size, value=abs(size.value))) for size in sizes}
        return clause.format(who=who, element=element, grow=grow, sense=sense, **values)
    physics = info.physics.split(". ")[0].split(": ")[0].rstrip(".")
    told = ", ".join(f"{name} {value}" for name, value in values.items())
    return f"{info.name} of {who} ({physics[:1].lower()}{physics[1:]}): {told}"


def size_words(size: Size) -> str:
    """Return a value with its uncertainty: ``15.0 ± 0.1 µm``."""
    unit = readable_unit(size.unit)
    shown = "" if unit == "1" else f" {unit}"
    if size.sigma is None or not size.sigma > 0.0:
        return f"{size.value:.3g}{shown}"
    places = max(0, -int(f"{size.sigma:.0e}".split("e")[1]))
    return f"{size.value:.{places}f} ± {size.sigma:.{places}f}{shown}"
