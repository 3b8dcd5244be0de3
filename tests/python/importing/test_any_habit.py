"""Tables of any mixture of habits give their values back; bytes of any kind give a record or one line."""

from __future__ import annotations

import string
from pathlib import Path

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from tests.python.importing.conftest import FOLDER

from hexdbb.errors import InputError
from hexdbb.importing import mapping_of, read_measured

QUICK = settings(max_examples=30, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
ANGLES = ["Angle [deg]", "Winkel (°)", "angle_deg", "Theta in Grad", "Polar angle / deg"]
READINGS = ["Deviation [µm]", "Abweichung in µm", "reading_um", "Ball bar error (µm)", "écart [µm]"]
WORDS = [("CCW", "CW"), ("1", "-1"), ("G03", "G02"), ("links", "rechts"), ("Counter-clockwise", "clockwise")]
DELIMITERS = {"semicolon": ";", "tab": "\t", "bar": "|", "comma": ","}


def number(value: float, places: int, decimal: str) -> str:
    return f"{value:.{places}f}".replace(".", decimal)


@QUICK
@given(data=st.data())
def test_any_mixture_of_habits_is_read(tmp_path_factory: object, data: st.DataObject) -> None:
    draw = data.draw
    delimiter = DELIMITERS[draw(st.sampled_from(list(DELIMITERS)))]
    decimal = draw(st.sampled_from([".", ","] if delimiter != "," else ["."]))
    places = draw(st.integers(1, 4))
    count = draw(st.integers(8, 40))
    readings = np.random.default_rng(draw(st.integers(0, 99))).uniform(-900.0, 900.0, 2 * count).round(places)
    readings[0], readings[1] = 0.5, 10.5  # a span that a circle shows, a number that tells the decimal mark
    step = 360.0 / count
    angles = np.concatenate([np.arange(count) * step, 360.0 - np.arange(count) * step])
    ccw, cw = draw(st.sampled_from(WORDS))
    order = draw(st.permutations(range(3)))
    heads = [draw(st.sampled_from(ANGLES)), draw(st.sampled_from(READINGS)), "Direction"]
    rows = [heads, *(
        [number(a, 3, decimal), number(r, places, decimal), ccw if k < count else cw]
        for k, (a, r) in enumerate(zip(angles, readings, strict=True))
    )]  # fmt: skip
    before = draw(st.sampled_from([[], ["Test of Monday"], ["Operator: Müller", ""]]))
    after = draw(st.sampled_from([[], ["", "End"], ["Max"]]))
    quoted = draw(st.booleans())
    cells = ((f'"{row[k]}"' if quoted else row[k] for k in order) for row in rows)
    lines = [*before, *map(delimiter.join, cells), *after]
    end = draw(st.sampled_from(["\n", "\r\n"]))
    encoding = draw(st.sampled_from(["utf-8", "utf-8-sig", "cp1252", "utf-16"]))
    path = tmp_path_factory.getbasetemp() / "any.csv"  # type: ignore[attr-defined]
    path.write_bytes((end.join(lines) + end).encode(encoding))
    record = read_measured(path, mapping_of(plan="thesis"))
    np.testing.assert_allclose(record.columns["reading_um"], readings, atol=1e-9)
    np.testing.assert_allclose(record.columns["angle_deg"], angles, atol=0.0005001)
    assert record.columns["direction"].tolist() == [1] * count + [-1] * count


WHOLE = {name: (FOLDER / name).read_bytes() for name in ("german.csv", "thousands.csv", "test.b5r", "merged.xlsx")}
CHOICES = {"units": {"reading": "mm"}, "start_angle_deg": 0.0, "arc_deg": 360.0}


@QUICK
@given(data=st.data())
def test_damaged_files_give_a_record_or_one_line(tmp_path_factory: object, data: st.DataObject) -> None:
    name = data.draw(st.sampled_from(list(WHOLE)))
    content = bytearray(WHOLE[name])
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(content) - 1))
        length = data.draw(st.sampled_from([1, 2, 40, 400]))
        content[at : at + length] = data.draw(
            st.binary(max_size=8) | st.text(string.printable, max_size=8).map(str.encode)
        )
        content = content or bytearray(b"\n")
    path: Path = tmp_path_factory.getbasetemp() / f"damaged{Path(name).suffix}"  # type: ignore[attr-defined]
    path.write_bytes(content)
    try:
        record = read_measured(path, mapping_of(plan="thesis", **(CHOICES if name == "test.b5r" else {})))
    except InputError as error:
        assert "\n" not in str(error)
        assert str(path) in str(error)
    else:
        assert len(record) >= 8
