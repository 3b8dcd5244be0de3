"""What a table of another program may hold: quantities, the names that people give them, and their units.

A heading such as ``Abweichung [µm]``, ``reading_um`` or ``CCW deviation / µm`` names a quantity and, at best, its unit.
"""

from __future__ import annotations

import difflib
import math
import re
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass

from hexdbb.record import SLIDER_COLUMNS

LENGTHS_MM = {"um": 1e-3, "mm": 1.0, "nm": 1e-6, "m": 1e3, "in": 25.4, "mil": 0.0254, "uin": 25.4e-6}
ANGLES_DEG = {"deg": 1.0, "rad": math.degrees(1.0), "mrad": math.degrees(1e-3), "gon": 0.9, "turn": 360.0}
TIMES_S = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0}
FEEDS_MM_MIN = {"mm/min": 1.0, "mm/s": 60.0, "m/min": 1e3, "in/min": 25.4}
TEMPERATURES_C = {"C": 1.0}
SPELLINGS = {
    **dict.fromkeys(("µm", "μm", "micron", "microns", "micrometer", "micrometre", "mikrometer", "micromètre"), "um"),
    **dict.fromkeys(("millimeter", "millimetre"), "mm"),
    **dict.fromkeys(("inch", "zoll", '"'), "in"),
    **dict.fromkeys(("°", "º", "degree", "degrees", "grad", "degré", "degrés", "degre", "degres"), "deg"),
    **dict.fromkeys(("radian", "radians", "radiant"), "rad"),
    **dict.fromkeys(("sec", "second", "seconds", "sek", "sekunden"), "s"),
    **dict.fromkeys(("µs", "μs"), "us"),
    **dict.fromkeys(("°c", "degc", "celsius", "c"), "C"),
    **dict.fromkeys(("mm_min", "mm/min.", "mmpm"), "mm/min"),
    "mm_s": "mm/s",
    "m_min": "m/min",
}
"""Other spellings of units, lower case."""


@dataclass(frozen=True)
class Quantity:
    """One quantity.

    Attributes
    ----------
    column : str
        Column of a record that it becomes.
    units : mapping of str to float
        Factor from each unit to the record's; empty where it has no unit.
    pattern : str
        Regular expression of its names, of what is left of a heading without its unit, lower case.
    """

    column: str
    units: Mapping[str, float]
    pattern: str


CCW = r"\bccw\b|counter.?clock|anti.?clock|gegen|\blinks|anti.?horaire|\bg0?3\b"
"""Words for counter-clockwise (G03 is the controllers' code), sought before those for clockwise, which some contain."""
CW = r"\bcw\b|clock|uhrzeiger|\brechts|horaire|\bg0?2\b"
_DEVIATION = (
    r"reading|deviation|deviat|abweich|radial|error|fehler|messwert|écart|ecart|ball.?bar|\bdev\b|\bdr\b|\bdelta"
)
_UM = {unit: factor * 1e3 for unit, factor in LENGTHS_MM.items()}

QUANTITIES: dict[str, Quantity] = {
    **{
        name.removesuffix("_mm"): Quantity(name, LENGTHS_MM, rf"^(s|slider|schlitten|axis|achse)[ _]?{k}$")
        for k, name in enumerate(SLIDER_COLUMNS, 1)
    },
    "temperature": Quantity("temperature_c", TEMPERATURES_C, r"temperat|\btemp\b"),
    "time": Quantity("t_s", TIMES_S, r"^t$|\btime|zeit|\btemps\b|\bdate|\bdatum\b"),
    "direction": Quantity("direction", {}, r"direction|richtung|^dir\b|drehsinn|\bsens\b|\bsense\b"),
    "feed": Quantity("feed_mm_min", FEEDS_MM_MIN, r"\bfeed|vorschub|avance"),
    "angle": Quantity("angle_deg", ANGLES_DEG, r"angle|winkel|\btheta\b|\bphi\b|azimut"),
    "reading_ccw": Quantity("reading_um", _UM, CCW),
    "reading_cw": Quantity("reading_um", _UM, CW),
    "lap": Quantity("lap", {}, r"^(lap|turn|umlauf|tour)\b"),
    "sweep": Quantity("sweep", {}, r"^(sweep|run|lauf|capture)\b"),
    "circle": Quantity("circle", {}, r"^(circle|kreis|cercle)\b"),
    "reading": Quantity("reading_um", _UM, _DEVIATION),
}
"""By name, as mapping files and options have it, in the order in which headings are compared with them."""
UNITS_OF: dict[str, tuple[str, ...]] = {name: tuple(each.units) for name, each in QUANTITIES.items()}
NEVER_STATED = {"direction", "lap", "sweep", "circle"}
"""Quantities without a unit."""

_BRACKETS = re.compile(r"[\[(<{]\s*([^\])>}]*?)\s*[\])>}]")
_SEPARATORS = re.compile(r"\s+in\s+|\s*[/,;:]\s*|\s+|_")


def nearest_quantity(name: str) -> str:
    """Return the quantity that was probably meant, else all there are."""
    close = difflib.get_close_matches(name, QUANTITIES, n=1, cutoff=0.6)
    return close[0] if close else ", ".join(QUANTITIES)


def known_unit(text: str) -> str | None:
    """Return a unit as mapping files have it; None where the text is none."""
    lowered = unicodedata.normalize("NFC", text).strip().lower().rstrip(".")
    unit = SPELLINGS.get(lowered, lowered)
    return unit if any(unit in units for units in UNITS_OF.values()) else None


def recognised(heading: str) -> tuple[str | None, str | None]:
    """Return the quantity and the unit that a heading names; None for either that it does not name."""
    text = " ".join(unicodedata.normalize("NFC", heading).lower().split())
    text, unit = _without_unit(text)
    words = text.replace("_", " ").strip()
    name = next((name for name, each in QUANTITIES.items() if re.search(each.pattern, words)), None)
    if name is not None and unit is not None and unit not in QUANTITIES[name].units:
        # A unit of another kind: what the heading names is not what it seems (`Radial feed [mm/min]`).
        other = next((n for n, q in QUANTITIES.items() if unit in q.units and re.search(q.pattern, words)), None)
        return other, unit if other is not None else None
    return name, unit


def _without_unit(text: str) -> tuple[str, str | None]:
    for found in _BRACKETS.finditer(text):
        if unit := known_unit(found[1]):
            return (text[: found.start()] + text[found.end() :]).strip(), unit
    for found in _SEPARATORS.finditer(text):
        if unit := known_unit(text[found.end() :]):
            return text[: found.start()].strip(), unit
    return text, None
