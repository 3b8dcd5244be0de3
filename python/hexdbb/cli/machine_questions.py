"""What `hexdbb machine new` asks: each question is a key of the machine file, an option, and a default.

Defaults are the shipped machine's proportions, applied to what was answered before.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import tomlkit

from hexdbb.cli.consoles import say
from hexdbb.cli.prompts import prompted
from hexdbb.errors import InputError
from hexdbb.files.validation import format_value, parse_toml
from hexdbb.machine import MachineFile, shipped_machine
from hexdbb.machine.dimensions import THIRDS_DEG

SHIPPED = shipped_machine()
Answers = Mapping[str, Any]


def _numbers(text: str) -> Any:
    """Return one number, or a list of them, of a text; whole numbers stay whole."""
    found = [int(each) if each.strip().lstrip("+-").isdigit() else float(each) for each in text.split(",")]
    return found[0] if len(found) == 1 else found


def _counted(*counts: int) -> Callable[[str], Any]:
    """Return a parser of as many numbers as one of some counts says."""

    def numbers(text: str) -> Any:
        if text.count(",") + 1 not in counts:
            raise ValueError(text)
        return _numbers(text)

    return numbers


def _one_number(text: str) -> Any:
    return _counted(1)(text)


def _travels(text: str) -> Any:
    """Return one pair of numbers, or a list of six pairs, of a text."""
    pairs = [_counted(2)(each) for each in text.split(";")]
    if len(pairs) not in (1, 6):
        raise ValueError(text)
    return pairs[0] if len(pairs) == 1 else pairs


@dataclass(frozen=True)
class Question:
    """One key of the machine file.

    Attributes
    ----------
    option : str
        Name of the option, without dashes.
    key : tuple of str
        Path in the file.
    text : str
        The question, and the option's help.
    default : callable
        Of the answers so far, as text.
    parse : callable
        Text to the value in the file; raises ValueError.
    form : str
        What is expected, for messages.
    """

    option: str
    key: tuple[str, ...]
    text: str
    default: Callable[[Answers], str]
    parse: Callable[[str], Any] = _one_number
    form: str = "a number"

    def value(self, text: str) -> Any:
        """Return the value of an answer; `InputError` where it is none."""
        try:
            return self.parse(text)
        except ValueError:
            raise InputError(f"--{self.option}: {format_value(text)} (expected {self.form})") from None


def _fixed(value: object) -> Callable[[Answers], str]:
    text = ",".join(f"{each:g}" for each in value) if isinstance(value, tuple) else str(value)
    return lambda _: text


def _of_inradius(shipped_mm: float) -> Callable[[Answers], str]:
    """Return the default of a length in proportion to the inradius."""
    return lambda known: f"{round(float(known['inradius']) * shipped_mm / SHIPPED.base.inradius_mm):g}"


def _travel(known: Answers) -> str:
    """Return the travel that leaves 20 mm at both ends of guideways as long as the triangle's sides."""
    side_mm = 2.0 * math.sqrt(3.0) * float(known["inradius"])
    return f"20,{round(side_mm - 20.0):g}"


_CAN, _LIMITS = SHIPPED.can_setup, SHIPPED.can_setup.limits
QUESTIONS = (
    Question("name", ("name",), "Name of the machine", _fixed("my HexGlider"), str, "a text"),
    Question(
        "inradius",
        ("base", "inradius_mm"),
        "BR: distance of each guideway from the base centre, mm",
        _fixed(f"{SHIPPED.base.inradius_mm:g}"),
    ),
    Question(
        "guideway-angles",
        ("base", "guideway_angles_deg"),
        "Directions of guideways 1 to 3 seen from above, deg",
        _fixed(THIRDS_DEG),
        _counted(3),
        form="three numbers with commas",
    ),
    Question(
        "circumradius",
        ("platform", "circumradius_mm"),
        "UR: distance of each ball joint from the platform's axis, mm",
        _of_inradius(SHIPPED.platform.circumradius_mm),
    ),
    Question(
        "joint-angles",
        ("platform", "joint_angles_deg"),
        "Directions of ball joints 1 to 3 on the platform, deg",
        _fixed(THIRDS_DEG),
        _counted(3),
        form="three numbers with commas",
    ),
    Question(
        "joint-height",
        ("platform", "joint_plane_height_mm"),
        "IH: height of the ball joints above the platform's reference point, mm",
        _fixed(f"{SHIPPED.platform.joint_plane_height_mm:g}"),
    ),
    Question(
        "mass",
        ("platform", "moved_mass_kg"),
        "Mass of platform and tool, kg",
        _fixed(f"{SHIPPED.platform.moved_mass_kg:g}"),
    ),
    Question(
        "leg-length",
        ("legs", "length_mm"),
        "l: length of the legs, mm; six numbers with commas where they differ",
        _of_inradius(SHIPPED.legs.lengths_mm[0]),
        _counted(1, 6),
        form="one number, or six with commas",
    ),
    Question(
        "travel",
        ("sliders", "travel_mm"),
        "Least and largest slider coordinate, mm; six pairs with semicolons where they differ",
        _travel,
        _travels,
        "two numbers with a comma, or six pairs with semicolons",
    ),
    Question(
        "gap",
        ("sliders", "min_gap_mm"),
        "Least distance of two sliders on one guideway, mm",
        _fixed(f"{SHIPPED.sliders.min_gap_mm:g}"),
    ),
    Question(
        "lead",
        ("sliders", "screw_lead_mm"),
        "Slider travel per turn of the screw, mm",
        _fixed(f"{SHIPPED.sliders.screw_lead_mm:g}"),
    ),
    Question(
        "nodes",
        ("can", "drive_nodes"),
        "CAN node ids of the drives of sliders 1 to 6",
        _fixed(_CAN.drive_nodes),
        _counted(6),
        form="six whole numbers with commas",
    ),
    Question(
        "gauge-node", ("can", "gauge_node"), "CAN node id of the gauge", _fixed(_CAN.gauge_node), form="a whole number"
    ),
    Question("counts-per-mm", ("can", "counts_per_mm"), "Encoder increments per mm", _fixed(f"{_CAN.counts_per_mm:g}")),
    Question(
        "velocity",
        ("can", "limits", "velocity_mm_s"),
        "Largest velocity of a slider, mm/s",
        _fixed(f"{_LIMITS.velocity_mm_s:g}"),
    ),
    Question(
        "acceleration",
        ("can", "limits", "acceleration_mm_s2"),
        "Largest acceleration of a slider, mm/s2",
        _fixed(f"{_LIMITS.acceleration_mm_s2:g}"),
    ),
    Question(
        "jerk", ("can", "limits", "jerk_mm_s3"), "Largest jerk of a slider, mm/s3", _fixed(f"{_LIMITS.jerk_mm_s3:g}")
    ),
)
"""In the order in which they are asked."""


def ask(given: Mapping[str, str | None], origin: str, interactive: bool) -> MachineFile:
    """Ask what was not given, and return the machine.

    Parameters
    ----------
    given : mapping of str to str or None
        Answers by option; None where not given.
    origin : str
        Name of the file to be written, for messages.
    interactive : bool
        Whether questions are asked, a wrong answer again; otherwise defaults are taken and a wrong value is an error.

    Raises
    ------
    InputError
        One line naming option or key, value and what was expected.
    """
    answers: dict[str, Any] = {}
    for question in QUESTIONS:
        text = given[question.option]
        if text is None:
            text = question.default(answers)
            answers[question.option] = _asked(question, answers, origin) if interactive else question.value(text)
        else:
            answers[question.option] = question.value(text)
    while True:
        try:
            return _machine(answers, origin)
        except InputError as error:
            wrong = next((each for each in QUESTIONS if _names(error, each)), None)
            if not interactive or wrong is None:
                raise
            say(f"  {error}", err=True)
            answers[wrong.option] = _asked(wrong, answers, origin)


def _asked(question: Question, answers: Answers, origin: str) -> Any:
    """Ask until the answer can be one: a wrong one would make the defaults of what is asked next."""
    while True:
        text = prompted(question.option, question.text, default=question.default(answers), type=str)
        try:
            answer = question.value(text)
            _check(question, {**answers, question.option: answer}, origin)
            return answer
        except InputError as error:
            say(f"  {error}", err=True)


def _check(question: Question, answers: Answers, origin: str) -> None:
    """Check an answer, with the defaults of what is not asked yet; `InputError` where its key is wrong."""
    if question.option == "travel":  # may be too short for the default of a gap that is asked next, not for the gap
        return
    known = dict(answers)
    for each in QUESTIONS:
        if each.option not in known:
            known[each.option] = each.value(each.default(known))
    try:
        _machine(known, origin)
    except InputError as error:
        if _names(error, question):
            raise


def _names(error: InputError, question: Question) -> bool:
    return f": {'.'.join(question.key)}" in str(error)


def _machine(answers: Answers, origin: str) -> MachineFile:
    """Validate the answers as the file that they make."""
    content: dict[str, Any] = {"schema": "hexdbb.machine/1"}
    for question in QUESTIONS:
        table = content
        for key in question.key[:-1]:
            table = table.setdefault(key, {})
        table[question.key[-1]] = answers[question.option]
    return parse_toml(tomlkit.dumps(content), MachineFile, origin)
