"""What commands show on terminals of 60 and 80 characters and in pipes: no digit dropped, no name cut.

The golden texts in tests/data/terminal are looked at before they are kept; `HEXDBB_GOLDEN=write` writes them anew.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest
from rich.table import Column, Table
from rich.text import Text
from tests.circle_plan import circle_plan
from tests.programs import called
from tests.terminals import on_terminal, terminal

from hexdbb.cli.consoles import output_console
from hexdbb.record import write_record
from hexdbb.rig.truth import random_truth
from hexdbb_truth.plans import discovery_plan
from hexdbb_truth.simulate import Pace, simulate

OF_ROUNDING = re.compile(r"\d\.\d\de\+1\d")
"""Sizes of which a plan shows nothing, divided by what rounding leaves: no two computers agree on them."""
GOLDEN = Path(__file__).parents[2] / "data" / "terminal"
README = Path(__file__).parents[3] / "README.md"
WIDTHS = (60, 80)
STYLE = re.compile(r"\x1b\[[\d;]*m")
COLOUR = re.compile(r"\x1b\[(?:[\d;]*;)?(?:3[0-8]|4[0-8]|9[0-7]|10[0-7])[;m]")
COMMANDS = {
    "plan-check": "plan check plan.toml --noise 0.5",
    "plan-compare": "plan compare plan.toml a_plan_of_a_rather_long_name.toml --noise 0.5",
    "effects": "effects",
    "diagnose": "diagnose tiny.parquet -m model.toml",
    "compare": "compare tiny.parquet -m model.toml --no-cause --no-plot",
    "thesis-estimate": "thesis estimate tiny.parquet --errors leg1,leg3,y1",
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with two plans, a record of four seconds a circle, and a model."""
    place = tmp_path_factory.mktemp("terminal")
    for name in ("plan.toml", "a_plan_of_a_rather_long_name.toml"):
        (place / name).write_text(circle_plan(), encoding="utf-8")
    plan = discovery_plan()
    few = plan.model_copy(update={"laps": 1, "circles": plan.circles[:2], "feeds_mm_min": (3000.0,)})
    made = simulate(random_truth(11), few, pace=Pace(rate_hz=5.0, instants_per_sample=1, travel_s=1.0))
    write_record(made, place / "tiny.parquet", overwrite=True)
    assert called("hexdbb", "diagnose", "tiny.parquet", "-m", "model.toml", folder=place).returncode == 0
    return place


def words(text: str) -> Counter[str]:
    """Words and numbers of a printed text, without lines of tables, colours and the colons of the long form."""
    return Counter(word for each in STYLE.sub("", text).split() if (word := each.strip("─:,")))


def shown(folder: Path, command: str, width: int, **variables: str) -> str:
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        return on_terminal(width, *command.split(), **variables)


def golden(name: str, text: str) -> None:
    lines = "".join(f"{line.rstrip()}\n" for line in STYLE.sub("", text).splitlines())
    lines = OF_ROUNDING.sub("#.##e+##", lines)
    path = GOLDEN / f"{name}.txt"
    if os.environ.get("HEXDBB_GOLDEN") == "write":
        path.write_text(lines, encoding="utf-8")
    assert lines == path.read_text(encoding="utf-8")


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("name", COMMANDS)
def test_terminal_shows_every_digit_and_name(folder: Path, name: str, width: int) -> None:
    text = shown(folder, COMMANDS[name], width, NO_COLOR="1")
    piped = called("hexdbb", *COMMANDS[name].split(), folder=folder).stdout
    assert not words(piped) - words(text) - headings(piped)
    assert "…" not in text
    golden(f"{name}-{width}", text)


def headings(text: str) -> Counter[str]:
    """Words of the headings of tables, of which the long form leaves out those of empty cells, and joins others."""
    lines = text.splitlines()
    above = [lines[max(k - 3, 0) : k] for k, line in enumerate(lines) if line.strip(" ─") == "" and "─" in line]
    return words("\n".join(line for each in above for line in each))


@pytest.mark.parametrize("name", COMMANDS)
def test_pipe_is_neither_cut_nor_coloured_nor_as_narrow_as_a_terminal(folder: Path, name: str) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COLUMNS", "60")
        piped = called("hexdbb", *COMMANDS[name].split(), folder=folder).stdout
    assert "\x1b" not in piped
    assert "…" not in piped
    assert max(map(len, piped.splitlines())) > max(WIDTHS) or name == "thesis-estimate"
    golden(f"{name}-pipe", piped)


@pytest.mark.parametrize(("variables", "coloured"), [({}, True), ({"NO_COLOR": "1"}, False), ({"TERM": "dumb"}, False)])
def test_no_color_leaves_colours_out(variables: dict[str, str], coloured: bool) -> None:
    with terminal(60, **variables) as text:
        output_console().print(Text("warning: a gauge that drifts", style="yellow"))
    assert STYLE.sub("", text.getvalue()) == "warning: a gauge that drifts\n"
    assert bool(COLOUR.search(text.getvalue())) == coloured


def test_a_table_is_narrowed_between_words_before_it_is_taken_apart() -> None:
    table = Table("name", Column("value, µm", justify="right"), "what it means", box=None, pad_edge=False)
    table.add_row("guideway_rotation_centre", "-206.4 / -206.3", "turned about the vertical")
    table.add_row("", "1.0", "")
    for width, taken_apart in ((51, False), (50, True)):
        with terminal(width) as text:
            output_console().print(table)
        printed = STYLE.sub("", text.getvalue())
        assert ("name: guideway_rotation_centre\nvalue, µm: -206.4 / -206.3\n" in printed) == taken_apart
        assert ("guideway_rotation_centre  -206.4 / -206.3  turned" in printed) != taken_apart
        assert max(map(len, printed.splitlines())) <= width


@pytest.mark.parametrize(
    ("program", "variable", "typed", "offered"),
    [("hexdbb", "_HEXDBB_COMPLETE", "pla", "plan"), ("hexdbb-run", "_HEXDBB_RUN_COMPLETE", "--ver", "--version")],
)
def test_names_are_completed(program: str, variable: str, typed: str, offered: str) -> None:
    asked = {variable: "bash_complete", "COMP_WORDS": f"{program} {typed}", "COMP_CWORD": "1"}
    line = f"import sys; sys.argv[0] = {program!r}; from hexdbb_start import {program.replace('-', '_')} as run; run()"
    done = subprocess.run(
        [sys.executable, "-c", line], env={**os.environ, **asked}, capture_output=True, text=True, check=True
    )
    assert done.stdout == f"plain,{offered}\n"
    assert f'eval "$({variable}=bash_source {program})"' in README.read_text(encoding="utf-8")
