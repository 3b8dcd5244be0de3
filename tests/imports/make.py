"""Write the files of `tests/data/imports`: one simulated test in the habits of many programs.

``python -m tests.imports.make`` simulates the thesis' circle on a machine with backlash (`hexdbb_truth`), writes it in
text form (`source.csv`), and then as others would write it. Tests compare every import with the source.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterable, Sequence
from datetime import datetime, timedelta
from pathlib import Path
from xml.sax.saxutils import escape

import numpy as np
from openpyxl import Workbook

from hexdbb.plan import load_plan
from hexdbb.record import SLIDER_COLUMNS, Record, read_record, write_record
from hexdbb_truth.cases import case
from hexdbb_truth.simulate import Pace, simulate

FOLDER = Path(__file__).parents[1] / "data" / "imports"
CASE = "backlash-x10-s3"
PACE = Pace(rate_hz=4.0, instants_per_sample=30)
"""200 readings a turn."""
BEGAN = datetime(2026, 3, 2, 8, 30)


def source() -> Record:
    """Return the record that all files hold."""
    hidden = case(CASE)
    return simulate(hidden.truth, load_plan("thesis"), 3, PACE)


def comma(value: float, places: int) -> str:
    return f"{value:.{places}f}".replace(".", ",")


def grouped(value: float, places: int) -> str:
    return f"{value:,.{places}f}".translate(str.maketrans(",.", ".,"))


def text(name: str, lines: Iterable[str], encoding: str = "utf-8", end: str = "\n") -> None:
    (FOLDER / name).write_bytes((end.join(lines) + end).encode(encoding))


def places(record: Record) -> list[tuple[float, float, float]]:
    """Return place, counter-clockwise and clockwise reading of the angles that both runs pass."""
    by_sign: dict[int, dict[float, float]] = {1: {}, -1: {}}
    for sign, angle, reading in zip(
        *(record.columns[n] for n in ("direction", "angle_deg", "reading_um")), strict=True
    ):
        by_sign[int(sign)].setdefault(round(float(angle), 1) % 360.0, float(reading))
    both = sorted(by_sign[1].keys() & by_sign[-1].keys())
    return [(angle, by_sign[1][angle], by_sign[-1][angle]) for angle in both]


def write_texts(record: Record) -> None:
    columns = record.columns
    angle, reading, sign, time = (columns[n] for n in ("angle_deg", "reading_um", "direction", "t_s"))
    each = list(zip(angle, reading, sign, time, strict=True))
    words = {1: "gegen Uhrzeigersinn", -1: "im Uhrzeigersinn"}
    german = ["Kreisformtest;;", "Prüfer;Müller;", ";;", "Winkel [°];Abweichung [µm];Drehsinn"]
    text(
        "german.csv",
        [*german, *(f"{comma(a, 3)};{comma(r, 1)};{words[int(d)]}" for a, r, d, _ in each)],
        "cp1252",
        "\r\n",
    )
    plain = (f"{r:.1f},{a:.4f},{d:+d},keep" for a, r, d, _ in each)
    text("plain.csv", ["reading_um,angle_deg,direction,operator", *plain], "utf-8-sig", "\r\n")
    wide = [f"{a:.1f},{up:.1f},{down:.1f}" for a, up, down in places(record)]
    footer = ["", f"Mean,{reading.mean():.2f},{reading.mean():.2f}", "Evaluated by hand"]
    text("wide.csv", ["Position angle (deg),CCW deviation (µm),CW deviation (µm)", *wide, *footer])
    unwrapped = np.unwrap(np.radians(angle))
    unwrapped[sign > 0] -= unwrapped[sign > 0][0]
    tabs = (f"{t:.3f}\t{a:.6f}\t{r / 1000.0:.5f}" for a, (_, r, _, t) in zip(unwrapped, each, strict=True))
    text("tabs.txt", ["Time (s)\tTheta (rad)\tBall bar error (mm)", *tabs], "utf-16")
    text("spaces.dat", (f"{a:10.4f} {d:3d} {r:9.1f}" for a, r, d, _ in each))
    mapping = [
        'schema = "hexdbb.mapping/1"',
        'plan = "thesis"',
        "header = 0",
        "[columns]",
        "angle = 1",
        "direction = 2",
    ]
    text("spaces.toml", [*mapping, "reading = 3", "[units]", 'reading = "um"', 'angle = "deg"'])
    ms = (f"{grouped(t * 1e3, 1)};{comma(a, 2)};{comma(r, 1)};{'G03' if d > 0 else 'G02'}" for a, r, d, t in each)
    text("thousands.csv", ["Zeit in ms;Winkel in Grad;Messwert in µm;Richtung", *ms])
    mm = [f"{a:.3f}|{'CCW' if d > 0 else 'CW'}|{r / 1000.0:.5f}" for a, r, d, _ in each]
    text("millimetres.csv", ["Angle, deg|Run direction|Deviation, mm", *mm])
    text("mm_as_um.csv", ["Angle, deg|Run direction|Deviation, µm", *mm])
    radians = (f"{np.radians(a):.6f},{'CCW' if d > 0 else 'CW'},{r:.1f}" for a, r, d, _ in each)
    text("radians_as_degrees.csv", ["Angle [deg],Direction,Deviation [um]", *radians])
    runs = {d: [f"{a:.3f},{r:.1f}" for a, r, sign_, _ in each if sign_ == d] for d in (1, -1)}
    head = "Angle (deg),Deviation (um)"
    text("two_tables.csv", ["Run 1 CCW", head, *runs[1], "", "Run 2 CW", head, *runs[-1]])
    bad = [f"{a:.3f},{r:.1f},{d}" for a, r, d, _ in each]
    bad[117] = bad[117].replace(f"{reading[117]:.1f}", "#REF!")
    text("bad_cell.csv", ["Angle (deg),Deviation (um),Direction", *bad])
    sliders = zip(*(columns[name] for name in SLIDER_COLUMNS), strict=True)
    heads = ",".join(f"Slider {k} (mm)" for k in range(1, 7))
    rows = (
        f"{t:.3f},{a:.4f},{d},{r:.1f}," + ",".join(f"{s:.4f}" for s in own)
        for (a, r, d, t), own in zip(each, sliders, strict=True)
    )
    text("sliders.csv", [f"Time (s),Angle (deg),Direction,Reading (um),{heads}", *rows])


def workbook(name: str, fill: Callable[[Workbook], None]) -> None:
    book = Workbook()
    fill(book)
    book.properties.creator = "hexdbb"
    book.properties.created = book.properties.modified = BEGAN
    book.save(FOLDER / name)


def write_workbooks(record: Record) -> None:
    def merged(book: Workbook) -> None:
        sheet = book.active
        sheet.append(["Ball bar test", None, None])
        sheet.append([])
        sheet.append(["Place", "Radial deviation", None])
        sheet.append(["Angle", "CCW", "CW"])
        sheet.append(["deg", "µm", "µm"])
        sheet.merge_cells("B3:C3")
        for row in places(record):
            sheet.append(row)

    def dated(book: Workbook) -> None:
        book.active.title = "Notes"
        book.active.append(["Measured on Monday, the machine cold"])
        sheet = book.create_sheet("Monday")
        sheet.append(["Date", "Angle [deg]", "Direction", "Deviation [µm]", "Temperature [°C]"])
        columns = (record.columns[name] for name in ("t_s", "angle_deg", "direction", "reading_um"))
        for time, angle, sign, reading in zip(*columns, strict=True):
            moment = BEGAN + timedelta(milliseconds=round(float(time) * 1e3))
            sheet.append([moment, round(float(angle), 3), "CCW" if sign > 0 else "CW", float(reading), 20.5])

    workbook("merged.xlsx", merged)
    workbook("dates.xlsx", dated)


def b5r(name: str, tests: Sequence[str]) -> None:
    body = "\n".join(tests)
    whole = body if len(tests) == 1 else f"<TEST_DOCUMENTS>\n{body}\n</TEST_DOCUMENTS>"
    text(name, ['<?xml version="1.0" encoding="utf-8"?>', whole])


def renishaw(record: Record, name: str, stated: str = "") -> str:
    """Return a test in the form of Renishaw's files, as far as that is publicly known."""
    runs = []
    for sign, word in ((1, "CCW"), (-1, "CW")):
        readings = record.columns["reading_um"][record.columns["direction"] == sign]
        values = "\n".join(f"{each / 1000.0:.5f}" for each in readings)
        feature = f'<FEATURE NAME="AF_CIRCULARITY" DT="UT_LENGTH_MM">{np.ptp(readings) / 1000.0:.4f}</FEATURE>'
        runs.append(
            f"<BALLBAR_RUN><RUN_DIRECTION>{word}</RUN_DIRECTION><READINGS{stated}>\n{values}\n</READINGS>{feature}</BALLBAR_RUN>"
        )
    return f"""<TEST_DOCUMENT>
<TEST_SPEC NAME="{escape(name)}"><INSTRUMENT MANUFACTURER="Renishaw"><DYNAMIC_BALLBAR>
<NOMINAL_LENGTH>100</NOMINAL_LENGTH><PROGRAMMED_FEEDRATE>753.98</PROGRAMMED_FEEDRATE>
<PLANE VIEW="+A+B" TEST_PLANE="XY"/>
</DYNAMIC_BALLBAR></INSTRUMENT></TEST_SPEC>
<RUN_RESULTS>
{chr(10).join(runs)}
</RUN_RESULTS>
</TEST_DOCUMENT>"""


def main() -> None:
    FOLDER.mkdir(exist_ok=True)
    write_record(source(), FOLDER / "source.csv", overwrite=True)
    record = read_record(FOLDER / "source.csv")
    write_texts(record)
    write_workbooks(record)
    stated = ' DT="UT_LENGTH_MM"'
    b5r("test.b5r", [renishaw(record, "100mm XY")])
    b5r("two_tests.b5r", [renishaw(record, "first", stated), renishaw(record, "second", stated)])
    shutil.rmtree(FOLDER / "__pycache__", ignore_errors=True)


if __name__ == "__main__":
    main()
