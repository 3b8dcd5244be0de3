"""Tests of Renishaw's ball-bar software (`.b5r`, XML) as a series of readings.

What is publicly known of the form: ``TEST_DOCUMENT`` holds ``TEST_SPEC`` (``INSTRUMENT``, ``DYNAMIC_BALLBAR`` with
``NOMINAL_LENGTH``, ``PROGRAMMED_FEEDRATE``, ``PLANE``), ``OPERATOR``, ``DATE_STARTED``, ``MACHINE_TESTED`` and
``RUN_RESULTS`` with a ``BALLBAR_RUN`` for each run: ``RUN_DIRECTION`` (CCW, CW), ``READINGS``, and ``FEATURE``s, whose
attribute ``DT`` names a unit (``UT_LENGTH_MM``, ``UT_LENGTH_UM``). No file with readings was at hand: they are taken as
numbers in the text of ``READINGS``, or one in each element below it, whose attribute or element ``ANGLE`` may state
the angle. A unit is believed where ``DT``, ``UNIT`` or ``UNITS`` states it; else it is asked for, as are angles.
The parser (defusedxml) refuses entities, so that no file unpacks to more than it is.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from hexdbb.errors import InputError
from hexdbb.importing.numbers import reader
from hexdbb.importing.quantities import QUANTITIES, UNITS_OF, known_unit
from hexdbb.importing.series import Floats, Series
from hexdbb.importing.setting import Setting
from hexdbb.importing.values import doubt_of

DIRECTIONS = {"CCW": 1, "CW": -1, "ANTICLOCKWISE": 1, "COUNTERCLOCKWISE": 1, "CLOCKWISE": -1}
UNIT_TYPES = {
    "UT_LENGTH_MM": "mm",
    "UT_LENGTH_UM": "um",
    "UT_LENGTH_INCH": "in",
    "UT_ANGLE_DEG": "deg",
    "UT_ANGLE_RAD": "rad",
}
"""Values of the attribute `DT`."""
UNIT_ATTRIBUTES = ("DT", "UNIT", "UNITS")
LEAST_READINGS = 8
"""Readings of a run; fewer are no circle."""

Element = Any
"""xml.etree.ElementTree.Element, as defusedxml makes it."""


def read_b5r(path: Path, setting: Setting) -> Series:
    """Read the runs of a test.

    Raises
    ------
    InputError
        No such XML, one that is truncated, several tests, or a unit, angle or feed that is not stated; one line naming
        the element, its value and what was expected.
    """
    spec, results, several = _chosen(path, _root(path), setting.mapping.test)
    ballbar = _only(path, spec, ".//DYNAMIC_BALLBAR", "TEST_SPEC")
    _require_bar(path, ballbar, setting)
    feed = _feed(path, ballbar, setting)
    runs = results.findall("BALLBAR_RUN")
    if not runs:
        raise InputError(f"{path}: RUN_RESULTS: holds no BALLBAR_RUN (expected one for each run)")
    parts, notes = [], [f"Renishaw test{several}, {len(runs)} runs"]
    for number, run in enumerate(runs, 1):
        parts.append(_run(f"{path}: BALLBAR_RUN {number}", run, setting))
    count = [len(part[0]) for part in parts]
    notes.append(f"{' + '.join(map(str, count))} readings in {parts[0][3]}, angles {parts[0][4]}")
    return Series(
        angle_deg=np.concatenate([part[0] for part in parts]),
        reading_um=np.concatenate([part[1] for part in parts]),
        direction=np.concatenate([np.full(len(part[0]), part[2], np.int8) for part in parts]),
        lines=np.concatenate([np.arange(1, each + 1) for each in count]),
        others={
            "sweep": np.repeat(np.arange(float(len(parts))), count),
            "feed_mm_min": np.full(sum(count), feed),
        },
        notes=notes,
        metadata=_described(spec, results, path),
    )


def _root(path: Path) -> Element:
    from xml.etree.ElementTree import ParseError  # of the parser that defusedxml guards

    import defusedxml
    from defusedxml.ElementTree import parse

    try:
        root = parse(path).getroot()
    except ParseError as error:
        line, column = error.position
        expected = "a whole XML file; this one is cut off or damaged"
        raise InputError(
            f"{path}: line {line}, column {column + 1}: not XML: {_reason(error)} (expected {expected})"
        ) from None
    except defusedxml.DefusedXmlException as error:
        raise InputError(f"{path}: declares {type(error).__name__} (expected XML without entities)") from None
    except (ValueError, LookupError) as error:  # of an encoding that it names and has not
        raise InputError(f"{path}: not XML: {error} (expected a Renishaw test)") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    if not list(root.iter("RUN_RESULTS")):
        raise InputError(f"{path}: {root.tag}: no RUN_RESULTS in it (expected a Renishaw test, TEST_DOCUMENT)")
    return root


def _reason(error: Exception) -> str:
    return str(error).partition(":")[0]


def _chosen(path: Path, root: Element, test: int | None) -> tuple[Element, Element, str]:
    """Return TEST_SPEC and RUN_RESULTS of the chosen test."""
    documents = [each for each in root.iter() if each.find("RUN_RESULTS") is not None]
    tests = [(document, results) for document in documents for results in document.findall("RUN_RESULTS")]
    names = ", ".join(f"{number}: {_name(document)}" for number, (document, _) in enumerate(tests, 1))
    if test is None and len(tests) > 1:
        raise InputError(f"{path}: holds {len(tests)} tests, {names} (expected --test, the number of one)")
    if test is not None and test > len(tests):
        raise InputError(f"{path}: test {test} is not there (expected one of {names})")
    document, results = tests[(test or 1) - 1]
    specs = document.findall("TEST_SPEC")
    if not specs:
        raise InputError(f"{path}: no TEST_SPEC (expected it: the bar's length and the feed stand there)")
    place = document.findall("RUN_RESULTS").index(results)
    spec = specs[place] if len(specs) > place else specs[0]
    return spec, results, f" {test} of {len(tests)}" if len(tests) > 1 else ""


def _name(document: Element) -> str:
    spec = document.find("TEST_SPEC")
    return "no TEST_SPEC" if spec is None else str(spec.get("NAME", "without a name"))


def _only(path: Path, element: Element, where: str, name: str) -> Element:
    found = element.find(where)
    if found is None:
        raise InputError(f"{path}: {name}: no {where.strip('./')} (expected it: the test of a ball bar)")
    return found


def _number(path: Path, parent: Element, name: str) -> float:
    element = parent.find(name)
    text = "" if element is None else (element.text or "").strip()
    value = reader(".")(text)
    if value is None:
        raise InputError(f'{path}: {parent.tag}: {name}: "{text}" (expected a number)')
    return value


def _require_bar(path: Path, ballbar: Element, setting: Setting) -> None:
    length, planned = _number(path, ballbar, "NOMINAL_LENGTH"), setting.plan.gauge.bar_length_mm
    if length != planned:
        expected = f"{planned:g}, gauge.bar_length_mm of {setting.plan_name}"
        raise InputError(f"{path}: NOMINAL_LENGTH: {length:g} (expected {expected})")


def _feed(path: Path, ballbar: Element, setting: Setting) -> float:
    """Return the feed; the file's number counts where it is one of the plan's, since its unit is not stated."""
    stated = _number(path, ballbar, "PROGRAMMED_FEEDRATE")
    if setting.mapping.feed_mm_min is not None:
        return setting.mapping.feed_mm_min
    planned = setting.feeds_mm_min(setting.circle(setting.circle_id(), "circle"))
    if stated not in planned:
        names = ", ".join(f"{each:g}" for each in planned)
        expected = f"a feed of {setting.plan_name}, {names} mm/min, or --feed: the unit is not stated"
        raise InputError(f"{path}: PROGRAMMED_FEEDRATE: {stated:g} (expected {expected})")
    return stated


def _run(where: str, run: Element, setting: Setting) -> tuple[Floats, Floats, int, str, str]:
    """Return angles (deg), readings (µm), direction, unit and source of the angles of one run."""
    word = (run.findtext("RUN_DIRECTION") or "").strip().upper().replace("-", "").replace("_", "")
    if word not in DIRECTIONS:
        raise InputError(f'{where}: RUN_DIRECTION: "{word}" (expected CCW or CW)')
    element = run.find("READINGS")
    if element is None:
        features = len(run.findall("FEATURE"))
        raise InputError(f"{where}: no READINGS, {features} FEATUREs only (expected a test saved with its readings)")
    values, angles = _numbers(f"{where}: READINGS", element)
    if len(values) < LEAST_READINGS:
        raise InputError(f"{where}: READINGS: {len(values)} (expected {LEAST_READINGS} at least)")
    unit = setting.mapping.units.get("reading") or _unit(element, "reading")
    if unit is None:
        largest = f"values up to {max(map(abs, values)):g}"
        expected = f"--unit reading=UNIT, one of {', '.join(UNITS_OF['reading'])}"
        raise InputError(f"{where}: READINGS: no unit is stated; {largest} (expected {expected})")
    reading_um = np.array(values) * QUANTITIES["reading"].units[unit]
    gauge = setting.plan.gauge
    doubt = doubt_of(reading_um, unit, gauge.range_um, gauge.bar_length_mm)
    if doubt and "reading" not in setting.mapping.units:
        raise InputError(f"{where}: READINGS, in {unit} as stated: {doubt}")
    sign = DIRECTIONS[word]
    angle_deg, source = _angles(where, element, angles, len(values), sign, setting)
    return angle_deg, reading_um, sign, unit, source


def _numbers(where: str, element: Element) -> tuple[list[float], list[float]]:
    """Return readings and, where each has one, angles."""
    number = reader(".")
    texts: list[tuple[str, str | None]] = []
    if len(element):
        for each in element:
            value = each.findtext("VALUE") if each.find("VALUE") is not None else each.text
            texts.append(((value or each.get("VALUE") or "").strip(), each.get("ANGLE") or each.findtext("ANGLE")))
    else:
        words = re.split(r"[\s;]+|,\s+", (element.text or "").strip().rstrip(",;"))
        # Without blanks a comma separates; beside blanks it would be a decimal comma, which is refused below.
        texts = [(word, None) for word in (words[0].split(",") if len(words) == 1 else words) if word]
    values, angles = [], []
    for place, (text, angle) in enumerate(texts, 1):
        value, at = number(text), None if angle is None else number(angle.strip())
        if value is None or (angle is not None and at is None):
            wrong = text if value is None else angle
            raise InputError(f'{where}: number {place}: "{wrong}" (expected a number with a decimal point)')
        values.append(value)
        if at is not None:
            angles.append(at)
    return values, angles


def _unit(element: Element, quantity: str) -> str | None:
    """Return the unit that an element, or the first below it, states for a quantity."""
    for each in _with_first(element):
        for attribute in UNIT_ATTRIBUTES:
            stated = each.get(attribute, "")
            unit = UNIT_TYPES.get(stated.upper()) or known_unit(stated)
            if unit in UNITS_OF[quantity]:
                return unit
    return None


def _with_first(element: Element) -> Iterator[Element]:
    yield element
    yield from list(element)[:1]


def _angles(
    where: str, element: Element, angles: Sequence[float], count: int, sign: int, setting: Setting
) -> tuple[Floats, str]:
    mapping = setting.mapping
    if angles and len(angles) == count:
        unit = mapping.units.get("angle") or _unit(element, "angle")
        if unit is None:
            raise InputError(f"{where}: READINGS: ANGLE: no unit is stated (expected --unit angle=deg or rad)")
        return np.array(angles) * QUANTITIES["angle"].units[unit], f"of the file, in {unit}"
    if mapping.start_angle_deg is None or mapping.arc_deg is None:
        expected = "--start-angle DEG of the first reading and --arc DEG to the last one, along each run"
        raise InputError(f"{where}: READINGS: no angles are stated (expected {expected})")
    start, arc = mapping.start_angle_deg, mapping.arc_deg
    return start + sign * np.linspace(0.0, arc, count), f"as stated, {arc:g}° from {start:g}°"


def _described(spec: Element, results: Element, path: Path) -> dict[str, Any]:
    """Return what a test says of itself: names, dates, plane, and the features that its software computed."""
    plane = spec.find(".//PLANE")
    features = [
        {"run": number, "name": each.get("NAME", ""), "type": each.get("DT", ""), "value": (each.text or "").strip()}
        for number, run in enumerate(results.findall("BALLBAR_RUN"), 1)
        for each in run.findall("FEATURE")
    ]
    said: dict[str, Any] = {"test": spec.get("NAME"), "plane": None if plane is None else dict(plane.attrib)}
    return {"renishaw": {key: value for key, value in {**said, "features": features}.items() if value}}
