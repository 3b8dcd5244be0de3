"""Tables of the page on imports, generated from what reads: quantities with their units, keys of a mapping file.

To rewrite the committed page: ``python -m hexdbb.importing.file_page docs``.
"""

from __future__ import annotations

import sys
from pathlib import Path

from hexdbb.importing.mapping import Mapping
from hexdbb.importing.quantities import QUANTITIES
from hexdbb.record.file_pages import key_tables, replaced

PAGE = "import.md"
BEGIN = "<!-- {}: made by `python -m hexdbb.importing.file_page docs`; do not edit -->"
END = "<!-- end of {} -->"
HEADINGS = {
    "angle": "Angle, Winkel, Theta, azimuth, ángulo, angolo, 角度",
    "reading": "Deviation, Abweichung, Reading, Error, Radial, Messwert, écart, desviación, scostamento, 偏差",
    "reading_ccw": "the same with CCW, counter-clockwise, gegen den Uhrzeigersinn, antihoraire, 反時計回り, G03",
    "reading_cw": "the same with CW, clockwise, im Uhrzeigersinn, horaire, 時計回り, G02",
    "direction": "Direction, Richtung, Drehsinn, sens, sentido, 方向",
    "time": "Time, Zeit, t, Date, temps, tiempo, 時間",
    "feed": "Feed, Vorschub, avance",
    "circle": "Circle, Kreis, cercle",
    "sweep": "Sweep, Run, Lauf",
    "lap": "Lap, Turn, Umlauf, tour",
    "temperature": "Temperature, Temp, 温度",
    "s1": "s1, Slider 1, Schlitten 1, Axis 1; `s2` to `s6` alike",
}
"""Headings that name each quantity; tests read every one of them."""


def quantity_table() -> str:
    """Return the Markdown table of quantities, their units and headings that name them."""
    rows = [
        f"| `{name}` | {', '.join(QUANTITIES[name].units) or 'none'} | {heads} |" for name, heads in HEADINGS.items()
    ]
    return "\n".join(["| quantity | units | headings that name it |", "|---|---|---|", *rows])


def updated(page: str) -> str:
    """Return the page's text with its tables generated anew."""
    tables = {"quantities": quantity_table(), "keys": key_tables(Mapping)}
    for name, table in tables.items():
        page = replaced(page, BEGIN.format(name), END.format(name), table)
    return page


def main(folder: Path) -> None:
    """Rewrite the tables of the page in a folder."""
    page = folder / PAGE
    page.write_text(updated(page.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
