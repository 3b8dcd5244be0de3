"""Whether a verdict is right: what was found beside what is hidden, in the truth's own words.

`right`; `more` (right, and something else besides); `element` (right effect, wrong element); `lead` (right, but not for
sure); `ambiguous` with the truth among those named; `variable`, `port` (learned at the right place over another
variable, at the right kind of place); `missed` (called unknown, or nothing); `false` (another effect named for sure, or
anything on a clean machine).
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from hexdbb.learned import Learned, Variable
from hexdbb.learned.following import BY_NUMBER
from hexdbb_truth.forms.labels import Label

NAMED = ("right", "more")
"""Outcomes in which the main cause is right, element and all."""
ORDER = ("false", "missed", "lead", "ambiguous", "port", "variable", "element", "right")
"""Outcomes of one fault, the worst first: that of several is the worst of them."""
PLACES = {"lateral": "guideway", "vertical": "guideway", "platform": "platform_joint"}
"""The truth's words for the places of learned hypotheses, where they differ."""
VARIABLES = {
    "fine_position": ("position",),
    "screw_phase": ("position",),
    "gap": ("position",),
    "direction": ("direction",),
    "direction_position": ("direction", "position"),
    "since_reversal_time": ("since_reversal", "direction"),
    "since_reversal_travel": ("since_reversal", "direction"),
    "time_position": ("time", "position"),
    "turning_rate": ("joint_turning",),
    "joint_angle_direction": ("joint_turning", "joint_angle"),
    "swing_rate": ("joint_turning",),
    "platform_turning_rate": ("joint_turning",),
    "platform_joint_angle": ("joint_angle",),
    "swing_angle": ("joint_angle",),
    "angle_direction": ("angle", "direction"),
    "bar_angle": ("angle",),
    "bar_azimuth": ("angle",),
    "fine_bar_angle": ("angle",),
    "fine_bar_azimuth": ("angle",),
    "turned": ("angle", "direction"),
    "circle_direction": ("direction",),
    "deflection_direction": ("deflection", "direction"),
    "joint_direction": ("joint_turning",),
    "joint_rate": ("joint_turning",),
    "joint_since_reversal": ("since_reversal", "joint_turning"),
    "deflection_since_turn": ("deflection", "direction"),
    "deflection_since_turn_by_deflection": ("deflection", "direction"),
    **{f"{load}_since_turn": ("leg_force", "direction") for load in ("leg_force", "drive_load", "carriage_load")},
    "drive_load": ("leg_force",),
    "carriage_load": ("leg_force",),
    "speed": ("feed", "velocity"),
    "reading": ("deflection",),
    "warming": ("time",),
    "step": ("time",),
    "fine_time": ("time",),
    "each_sweep": ("time",),
    "time_since_fixing": ("time",),
    "time_in_circle": ("time",),
    "roll": ("tilt",),
    "pitch": ("tilt",),
    "tilt_downhill": ("tilt",),
    "time_in_sweep": ("time_in_run",),
    "growth": ("time",),
    "time_period": ("time",),
    "position_period": ("position",),
    "direction_position_period": ("position", "direction"),
    "scale_period": ("deflection",),
    "acceleration_along": ("acceleration",),
    "position_along": ("position",),
    "velocity_along": ("velocity", "direction"),
    **{f"platform_{each}": ("position",) for each in ("x", "y", "z", "radius")},
    "leg_in_platform": ("joint_angle",),
    "leg_in_base": ("joint_angle",),
    "screw_wave_position": ("position",),
    "screw_wave_velocity": ("position", "velocity"),
    "position_wave": ("position",),
    "velocity_wave": ("position", "velocity"),
    "course": ("direction",),
    "course_speed": ("direction", "velocity"),
}
"""The truth's words for the variables of learned hypotheses, where they differ."""
OF_ANOTHER = r"^(neighbour|slider_\d)_"
"""Beginning of the name of a variable of another element than the one that is pushed."""


@dataclass(frozen=True)
class Named:
    """One cause that a verdict names.

    Attributes
    ----------
    name : str
        Of the effect, with its elements: ``backlash:4``, ``learned:vertical:1:fine_position``.
    grade : str
        Verdict on this cause alone.
    rivals, alike : sequence of str
        Other explanations, of another kind and of the same.
    """

    name: str
    grade: str
    rivals: Sequence[str] = ()
    alike: Sequence[str] = ()


def outcome_of(grade: str, found: Sequence[Named], labels: Sequence[Label], withheld: Sequence[str] = ()) -> str:
    """Return the outcome of a verdict.

    Parameters
    ----------
    grade : str
        ``none``, ``effect``, ``ambiguous`` or ``unknown``.
    found : sequence of Named
    labels : sequence of Label
        What is hidden.
    withheld : sequence of str
        Effects that were no candidates: of such a fault its place and variable are to be learned.
    """
    if not labels:
        return "right" if grade == "none" else "false"
    results = [
        _named(grade, found, label, labels)
        if label.catalogued and label.kind not in withheld
        else _learned(grade, found, label)
        for label in labels
    ]
    if len(found) > len(labels) and all(each in ("right", "element") for each in results):
        return "more"
    return min(results, key=ORDER.index)


def _accepted(label: Label) -> set[str]:
    """Return the effects that say what is hidden."""
    return {label.kind, *(each.effect for each in label.equivalents if each.effect)}


def _named(grade: str, found: Sequence[Named], label: Label, labels: Sequence[Label]) -> str:
    accepted = _accepted(label)
    for each in found:
        effect, _, elements = each.name.partition(":")
        rivals = {name.partition(":")[0] for rival in each.rivals for name in rival.split(" + ")}
        if effect in accepted:
            if each.grade == "ambiguous":
                return "ambiguous"
            # Beside what is learned, which has no known name, an effect may be surer than the verdict on both.
            if grade == "unknown" and not any(other.name.startswith("learned:") for other in found):
                return "lead"
            right = {str(number) for number in label.elements}
            for alike in each.alike:
                elements += ":" + alike.partition(":")[2]
            neighbours = {str(n) for e in label.equivalents if e.effect for n in e.elements or ()}
            named = set(elements.split(":"))
            return "right" if not right or effect != label.kind or named & (right | neighbours) else "element"
        if each.grade == "ambiguous" and rivals & accepted:
            return "ambiguous"
    # Another fault that is named is not false: this one is what is left.
    true = set().union(*map(_accepted, labels))
    is_false = grade == "effect" and any(each.name.partition(":")[0] not in true for each in found)
    return "false" if is_false else "missed"


def _learned(grade: str, found: Sequence[Named], label: Label) -> str:
    accepted = _accepted(label) - {label.kind}
    results = ["missed"]
    for each in found:
        rivals = [part for rival in each.rivals for part in rival.split(" + ")]
        if each.grade == "ambiguous" and any(_place_of(rival, label) == "right" for rival in rivals):
            results.append("ambiguous")
        is_other = not each.name.startswith("learned:") and each.name.partition(":")[0] not in accepted
        if is_other and grade == "effect":
            return "false"
        results.append(_place_of(each.name, label))
    return max(results, key=("missed", "port", "variable", "ambiguous", "right").index)


def _place_of(name: str, label: Label) -> str:
    """Return how near a named cause is to the truth: `right`, `variable` (another at this place), `port`, `missed`."""
    if not name.startswith("learned:"):
        effect, _, number = name.partition(":")
        return "right" if _is_stated(label, effect, number) else "missed"
    truths = [
        (label.port, label.variables, label.elements),
        *((each.port, (each.variable,), each.elements or ()) for each in label.equivalents),
    ]
    learned = Learned.parse(name)
    named = {int(each) for each in learned.element_name.split("-") if each.isdigit()}
    there = [
        set(variables)
        for port, variables, elements in truths
        if PLACES.get(learned.place, learned.place) == port and (not elements or named <= {*elements})
    ]
    asked = _truths_words(learned.variable)
    if any(all(words & variables for words in asked) for variables in there):
        return "right"
    return "variable" if there else "port"


def _truths_words(variable: Variable) -> list[set[str]]:
    """Return the truth's words for a variable; of a product those of either part, of which the truth must have both."""
    whole = name = re.sub(OF_ANOTHER, "", variable.name.partition("@")[0])
    for how in BY_NUMBER:
        name = name.removesuffix(f"_{how}")
    parts = (name,) if name in VARIABLES or not variable.parts else variable.parts
    # The truth may ask for the memory itself.
    own = (re.sub(OF_ANOTHER, "", each) for each in parts)
    return [{whole, *VARIABLES.get(each, (each,))} for each in own]


def _is_stated(label: Label, effect: str, number: str) -> bool:
    """Check whether a catalogue effect, at its element, is a stated equivalent of what is hidden."""
    at = [each.elements for each in label.equivalents if each.effect == effect]
    return any(not elements or (number.isdigit() and int(number) in elements) for elements in at)
