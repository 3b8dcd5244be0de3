"""A compensation file and its C header state their origin, and no name leaves the place it is written to."""

from __future__ import annotations

import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest

from hexdbb import _core
from hexdbb.compensation import make_compensation, read_compensation, write_compensation
from hexdbb.ledger import fit_model
from hexdbb.machine import MachineFile, shipped_machine
from hexdbb.model import Model, load_model, new_model, save_model
from hexdbb.plan import load_plan
from hexdbb.rig.truth import TruthFile
from hexdbb.samples import Samples
from hexdbb_truth.simulate import simulate

EVIL = [
    "x */ int evil = 1; /*",
    "x *\\\n/ int evil = 1; /*",
    "x *??/\n/ int evil = 1;",
    "ends with a backslash \\",
    "ends with a trigraph ??/",
    '"; int evil = 1; "',
    "\x1b[2J\u202e\u2028\u0085 evil \x00",
    "//\\\nint evil = 1;",
    "Größe 測定",
]


def machine_named(name: str) -> MachineFile:
    return shipped_machine().model_copy(update={"name": name})


def with_table(data: _core.CompensationData, effect: str) -> _core.CompensationData:
    """The same for the machine alone with one table, whose effect has a user's name."""
    table = _core.CompensationTable(
        effect=effect, port="leg", variable="", times="", period=0.0, pushes=[(0, 0, 1.0)], knots=[0.0], values_mm=[0.1]
    )
    model = new_model(machine_named(data.name), ["leg_length"])
    return _core.compensation_of(
        model.engine(),
        name=data.name,
        model_sha256=data.model_sha256,
        max_correction_mm=1.0,
        reversal_travel_mm=0.01,
        reference_temperature_c=20.0,
        tables=[table],
    )


def symbols_of(header: str, folder: Path, standard: str) -> set[str]:
    """Compile a header with every warning of comments an error, and return the names it defines."""
    (folder / "a.h").write_text(header)
    (folder / "a.c").write_text('#include "a.h"\nconst void *use = &hexdbb_compensation;\n')
    include = Path(__file__).parents[3] / "cpp" / "include"
    options = [f"-std={standard}", "-Wall", "-Wextra", "-Werror", "-trigraphs", "-Wcomment", "-fsyntax-only"]
    done = subprocess.run(
        ["cc", *options, "-I", str(include), str(folder / "a.c")], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    bare = subprocess.run(
        ["cc", "-E", "-P", f"-std={standard}", "-trigraphs", "-I", str(include), str(folder / "a.c")],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    return set(re.findall(r"\w+", re.sub(r'"(\\.|[^"\\])*"', "", bare)))


@pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")
@pytest.mark.parametrize("name", EVIL)
@pytest.mark.parametrize("standard", ["c99", "c17"])
def test_no_name_leaves_comment_or_string_of_the_header(tmp_path: Path, name: str, standard: str) -> None:
    data = with_table(make_compensation(new_model(machine_named(name), ["leg_length"])), name)
    assert "evil" not in symbols_of(data.header(), tmp_path, standard)


@pytest.mark.parametrize("name", EVIL)
def test_no_name_leaves_its_line_of_the_file(tmp_path: Path, name: str) -> None:
    data = with_table(make_compensation(new_model(machine_named(name), ["leg_length"])), name)
    write_compensation(data, tmp_path / "a.hexcomp")
    again = read_compensation(tmp_path / "a.hexcomp")
    assert again.text() == data.text()
    assert len(again.name.splitlines()) == 1
    assert all(each.isprintable() for each in again.name.replace("\x00", ""))
    printable = "".join(" " if not each.isprintable() else each for each in name)
    assert again.name == printable


@pytest.fixture(scope="module")
def fitted() -> tuple[Model, str]:
    """A model fitted to one record, and the record's content hash."""
    plan = load_plan("thesis")
    record = simulate(TruthFile(), plan, 3)
    thin = replace(record, columns={name: values[::40] for name, values in record.columns.items()})
    model = new_model(plan.machine_file(), ["leg_length", "cup_position"])
    return fit_model(Samples.of([thin]), model).model, thin.content_hash()


def test_file_and_header_state_model_and_records(fitted: tuple[Model, str], tmp_path: Path) -> None:
    model, record_hash = fitted
    save_model(model, tmp_path / "model.toml")
    data = make_compensation(load_model(tmp_path / "model.toml"))
    assert data.record_sha256 == [record_hash]
    for text in (data.text(), data.header()):
        assert record_hash in text
        assert data.model_sha256 in text
    write_compensation(data, tmp_path / "a.hexcomp")
    again = read_compensation(tmp_path / "a.hexcomp")
    assert again.record_sha256 == [record_hash]
    assert again.header() == data.header(), "a header made of the file states the same"


def test_the_records_stand_in_comments_that_readers_of_versions_1_and_2_pass_over(
    fitted: tuple[Model, str],
) -> None:
    """Earlier readers refuse keys that they do not know, and leave out every line that begins with '#'."""
    lines = make_compensation(fitted[0]).text().splitlines()
    assert f'# record_sha256 = "{fitted[1]}"' in lines
    assert lines[0] == 'schema = "hexdbb.compensation/1"'


def test_a_model_that_was_never_fitted_names_no_record() -> None:
    data = make_compensation(new_model(shipped_machine(), ["leg_length"]))
    assert data.record_sha256 == []
    assert "record" not in data.header().split("*/")[0]
