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
ANGLES_DEG = {"deg": 1.0, "rad": math.degrees(1.0), "mrad": math.degrees(1e-3), "mdeg": 1e-3, "gon": 0.9, "turn": 360.0}
TIMES_S = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0, "d": 86400.0}
FEEDS_MM_MIN = {"mm/min": 1.0, "mm/s": 60.0, "m/min": 1e3, "in/min": 25.4}
TEMPERATURES_C = {"C": 1.0}
SPELLINGS = {
    **dict.fromkeys(("μm", "micron", "microns", "micrometer", "micrometre", "mikrometer"), "um"),
    **dict.fromkeys(("micra", "micras", "micrometro", "micrometros", "微米", "ミクロン", "マイクロメートル"), "um"),
    **dict.fromkeys(("millimeter", "millimetre", "毫米", "ミリメートル"), "mm"),
    **dict.fromkeys(("inch", "inches", "zoll", "pouce", "pouces", "pollici", "pulgadas", '"'), "in"),
    **dict.fromkeys(("μin", "μinch", "microinch", "microinches"), "uin"),
    **dict.fromkeys(("mils", "thou"), "mil"),
    **dict.fromkeys(("°", "degree", "degrees", "grad", "degre", "degres", "grados", "gradi", "度"), "deg"),
    **dict.fromkeys(("radian", "radians", "radiant", "弧度", "ラジアン"), "rad"),
    **dict.fromkeys(("sec", "second", "seconds", "sek", "sekunden", "秒"), "s"),
    **dict.fromkeys(("days", "tage"), "d"),
    "μs": "us",
    **dict.fromkeys(("°c", "degc", "celsius", "c"), "C"),
    **dict.fromkeys(("mm_min", "mm/min.", "mmpm"), "mm/min"),
    "mm_s": "mm/s",
    "m_min": "m/min",
}
"""Other spellings of units, as `_plain` writes them."""


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


CCW = (
    r"\bccw\b|\bacw\b|counter.?clock|anti.?clock|gegen|\blinks|anti.?horai?r|antiorar|trigonom|\bg0?3\b"
    r"|反時計|逆時針|逆时针"
)
"""Words for counter-clockwise (G03 is the controllers' code), sought before those for clockwise, which some contain."""
CW = r"\bcw\b|clock|uhrzeiger|\brechts|horai?r|\borari|\bg0?2\b|時計|順時針|顺时针"
_DEVIATION = (
    r"reading|deviat|desvia|abweich|\babw\b|radial|error|fehler|messwert|ecart|scostament|ball.?bar|\bdev\b|\bdr\b"
    r"|\bdelta|偏差|誤差|误差"
)
_UM = {unit: factor * 1e3 for unit, factor in LENGTHS_MM.items()}

QUANTITIES: dict[str, Quantity] = {
    **{
        name.removesuffix("_mm"): Quantity(name, LENGTHS_MM, rf"^(s|slider|schlitten|axis|achse)[ _]?{k}$")
        for k, name in enumerate(SLIDER_COLUMNS, 1)
    },
    "temperature": Quantity("temperature_c", TEMPERATURES_C, r"temperat|\btemp\b|温度"),
    "time": Quantity("t_s", TIMES_S, r"^t$|\btime|zeit|\btemps\b|tiempo|\btempo\b|\bdate|\bdatum\b|時間|时间"),
    "direction": Quantity("direction", {}, r"direction|richtung|^dir\b|drehsinn|\bsens[eo]?\b|sentido|direzione|方向"),
    "feed": Quantity("feed_mm_min", FEEDS_MM_MIN, r"\bfeed|vorschub|avance|avanzament|进给|送り"),
    "angle": Quantity("angle_deg", ANGLES_DEG, r"angle|winkel|angulo|angolo|\btheta\b|\bphi\b|azimut|角度"),
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
_SPREAD = re.compile(r"[\u0300-\u036f]")
"""Accents, apart from their letters."""
_SEPARATORS = re.compile(r"\s+in\s+|\s*[/,;:]\s*|\s+|_")


def nearest_quantity(name: str) -> str:
    """Return the quantity that was probably meant, else all there are."""
    close = difflib.get_close_matches(name, QUANTITIES, n=1, cutoff=0.6)
    return close[0] if close else ", ".join(QUANTITIES)


def known_unit(text: str) -> str | None:
    """Return a unit as mapping files have it; None where the text is none."""
    lowered = _plain(text).rstrip(".")
    unit = SPELLINGS.get(lowered, lowered)
    return unit if any(unit in units for units in UNITS_OF.values()) else None


def _plain(text: str) -> str:
    """Return a text in lower case without accents, its full-width characters in the usual width."""
    usual = unicodedata.normalize("NFKD", text.replace("º", "°")).lower()
    return " ".join(unicodedata.normalize("NFC", _SPREAD.sub("", usual)).split())


def recognised(heading: str) -> tuple[str | None, str | None]:
    """Return the quantity and the unit that a heading names; None for either that it does not name."""
    text, unit = _without_unit(_plain(heading))
    words = text.replace("_", " ").strip()
    name = next((name for name, each in QUANTITIES.items() if re.search(each.pattern, words)), None)
    if name is not None and unit is not None and unit not in QUANTITIES[name].units:
        # A unit of another kind: what the heading names is not what it seems (`Radial feed [mm/min]`).
        other = next((n for n, q in QUANTITIES.items() if unit in q.units and re.search(q.pattern, words)), None)
        return other, unit if other is not None else None
    return name, unit


def stated_unit(heading: str) -> str | None:
    """Return the unit that a heading states, of whatever quantity; None where it states none."""
    return _without_unit(_plain(heading))[1]


def _without_unit(text: str) -> tuple[str, str | None]:
    for found in _BRACKETS.finditer(text):
        if unit := known_unit(found[1]):
            return (text[: found.start()] + text[found.end() :]).strip(), unit
    for found in _SEPARATORS.finditer(text):
        if unit := known_unit(text[found.end() :]):
            return text[: found.start()].strip(), unit
    return text, None
