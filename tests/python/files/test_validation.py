from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import Field, ValidationError

from hexdbb.errors import InputError
from hexdbb.files.validation import (
    FileModel,
    NotNegative,
    Number,
    Positive,
    StrictModel,
    Vector3,
    dump_toml,
    load_toml,
    parse_toml,
)


class Hole(StrictModel):
    radius_mm: Positive
    place_mm: Vector3
    note: str = ""


class Plate(FileModel):
    schema_id: Literal["test.plate/2"] = Field(default="test.plate/2", alias="schema")
    thickness_mm: Number
    mass_kg: NotNegative = 0.0
    count: Annotated[int, Field(ge=1)] = 1
    drilled: bool = False
    holes: Annotated[tuple[Hole, ...], Field(strict=False)] = Field(default=(), alias="hole")
    spare: Hole | None = None


GOOD = """schema = "test.plate/2"
thickness_mm = 3
count = 2
drilled = true
[[hole]]
radius_mm = 1.5
place_mm = [0, 1.0, 2.0]
[[hole]]
radius_mm = 2.5
place_mm = [1.0, 1.0, 2.0]
"""


def error_of(text: str) -> str:
    with pytest.raises(InputError) as caught:
        parse_toml(text, Plate, "plate.toml")
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_reads_a_good_file(tmp_path: Path) -> None:
    path = tmp_path / "plate.toml"
    path.write_text(GOOD)
    plate = load_toml(path, Plate)
    assert (plate.thickness_mm, plate.count, plate.drilled, plate.path) == (3.0, 2, True, path)
    assert [hole.radius_mm for hole in plate.holes] == [1.5, 2.5]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("radius_mm = 2.5", "radius_mm = -5", "hole[1].radius_mm: -5 (expected a number > 0)"),
        ("radius_mm = 2.5", 'radius_mm = "2.5"', 'hole[1].radius_mm: "2.5" (expected a number)'),
        ("radius_mm = 2.5", "radius_mm = true", "hole[1].radius_mm: true (expected a number)"),
        ("radius_mm = 2.5", "radius_mm = inf", "hole[1].radius_mm: inf (expected a finite number)"),
        ("radius_mm = 2.5", "", "hole[1].radius_mm: missing (expected this key)"),
        ("thickness_mm = 3", "thickness_mm = nan", "thickness_mm: nan (expected a finite number)"),
        ("count = 2", "count = 2.5", "count: 2.5 (expected a whole number)"),
        ("count = 2", "count = 0", "count: 0 (expected a number >= 1)"),
        ("count = 2", "mass_kg = -1", "mass_kg: -1 (expected a number >= 0)"),
        ("drilled = true", "drilled = 1", "drilled: 1 (expected true or false)"),
        ("[1.0, 1.0, 2.0]", "[1.0, 2.0]", "hole[1].place_mm[2]: missing (expected a value)"),
        (
            "[1.0, 1.0, 2.0]",
            "[1.0, 1.0, 2.0, 3.0]",
            "hole[1].place_mm: [1.0, 1.0, 2.0, 3.0] (expected a list of at most 3",
        ),
        ("[1.0, 1.0, 2.0]", "[1.0, nan, 2.0]", "hole[1].place_mm[1]: nan (expected a finite number)"),
        ("[1.0, 1.0, 2.0]", "7", "hole[1].place_mm: 7 (expected a list)"),
        ("drilled = true", "spare = 3", "spare: 3 (expected a table)"),
        ("place_mm = [1.0", "note = 3\nplace_mm = [1.0", "hole[1].note: 3 (expected a text in quotes)"),
    ],
)
def test_bad_value_is_one_line_with_key_value_and_expectation(old: str, new: str, message: str) -> None:
    assert error_of(GOOD.replace(old, new)).startswith(f"plate.toml: {message}")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("count", "cuont", "cuont: unknown key (expected count)"),
        (
            "thickness_mm",
            "thickness_um",
            "thickness_um: unknown key (expected thickness_mm: the unit is part of the key)",
        ),
        ("thickness_mm", "thickness", "thickness: unknown key (expected thickness_mm: the unit is part of the key)"),
        ("radius_mm = 2.5", "radius_m = 2.5", "hole[1].radius_m: unknown key (expected radius_mm: the unit"),
        (
            "count",
            "zzz",
            "zzz: unknown key (expected one of schema, thickness_mm, mass_kg, count, drilled, hole, spare)",
        ),
        ("[[hole]]", "[[holes]]", "holes: unknown key (expected hole)"),
        ("schema", "schema_id = 1\nschema", "schema_id: unknown key (expected schema)"),
        ("drilled = true", "[spare]\nradius_um = 1\n", "spare.radius_um: unknown key (expected radius_mm: the unit"),
    ],
)
def test_unknown_key_names_the_one_that_was_meant(old: str, new: str, message: str) -> None:
    assert error_of(GOOD.replace(old, new)).startswith(f"plate.toml: {message}")


@pytest.mark.parametrize(
    ("schema", "message"),
    [
        ("", 'schema: missing (expected schema = "test.plate/2")'),
        ('schema = "test.bowl/2"', 'schema: "test.bowl/2" (expected "test.plate/2")'),
        ('schema = "test.plate/1"', 'schema: "test.plate/1" (expected "test.plate/2")'),
        ('schema = "test.plate/3"', 'schema: "test.plate/3" (expected "test.plate/2"; this is a later version'),
        ("schema = 2", 'schema: 2 (expected "test.plate/2")'),
    ],
)
def test_schema_is_checked_before_all_else(schema: str, message: str) -> None:
    assert error_of(f"{schema}\nnonsense = 1\n").startswith(f"plate.toml: {message}")


def test_syntax_error_names_file_and_line() -> None:
    message = error_of(GOOD.replace("count = 2", "count == 2"))
    assert message.startswith("plate.toml: not valid TOML")
    assert "line 3" in message


def test_key_given_twice_is_an_error() -> None:
    assert "line 4" in error_of(GOOD.replace("count = 2", "count = 2\ncount = 3"))


def test_unreadable_files_are_one_line(tmp_path: Path) -> None:
    latin = tmp_path / "latin.toml"
    latin.write_bytes('name = "Führung"'.encode("latin-1"))
    for path, message in [(tmp_path / "none.toml", "no such file"), (tmp_path, "cannot be read"), (latin, "not UTF-8")]:
        with pytest.raises(InputError, match=message) as caught:
            load_toml(path, Plate)
        assert str(caught.value).startswith(f"{path}: ")
        assert "\n" not in str(caught.value)


def test_byte_order_mark_is_accepted(tmp_path: Path) -> None:
    path = tmp_path / "plate.toml"
    path.write_bytes(b"\xef\xbb\xbf" + GOOD.encode())
    assert load_toml(path, Plate).count == 2


def test_where_it_was_read_does_not_count_in_equality(tmp_path: Path) -> None:
    path = tmp_path / "plate.toml"
    path.write_text(GOOD)
    read, made = load_toml(path, Plate), parse_toml(GOOD, Plate, "made")
    assert read == made and hash(read) == hash(made)
    assert read != parse_toml(GOOD.replace("2.5", "2.6"), Plate, "made")


def test_does_not_change_once_read() -> None:
    plate = parse_toml(GOOD, Plate, "plate.toml")
    with pytest.raises(ValidationError):
        plate.count = 3


finite = st.floats(allow_nan=False, allow_infinity=False)


@given(thickness=finite, place=st.tuples(finite, finite, finite), note=st.text(st.characters(codec="utf-8")))
def test_written_and_read_again_to_the_last_bit(thickness: float, place: tuple[float, float, float], note: str) -> None:
    plate = Plate(thickness_mm=thickness, hole=(Hole(radius_mm=1.0, place_mm=place, note=note),))
    again = parse_toml(dump_toml(plate), Plate, "dumped")
    assert again == plate
    assert repr(again) == repr(plate), "also the sign of zero"


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("[" * 3000 + "]" * 3000, "plate.toml: not valid TOML: nested too deep"),
        ("{a=" * 3000 + "1" + "}" * 3000, "plate.toml: not valid TOML: nested too deep"),
        ("9" * 5000, "plate.toml: not valid TOML: a number with too many digits"),
    ],
)
def test_what_the_toml_reader_itself_gives_up_on_is_one_line(value: str, message: str) -> None:
    assert error_of(f"extra = {value}\n{GOOD}").startswith(message)
