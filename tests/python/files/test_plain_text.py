"""Names that hold what a terminal or a formula would obey are shown as they are, wherever a command prints them."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path

import pytest
from matplotlib.figure import Figure
from rich.table import Table
from rich.text import Text
from tests.programs import called

from hexdbb.files.plain_text import TextConsole, plain_text, printable
from hexdbb.ledger.history import History
from hexdbb.machine import shipped
from hexdbb.model.ledger import LedgerStep
from hexdbb.plots.saving import save_figure
from hexdbb.record import Record
from hexdbb.samples import Samples

EVIL = "\x1b[2J\x1b]0;title\x07\u202egnp\u2028\x9b31m [/bold] [red]"
SHOWN = r"\x1b[2J\x1b]0;title\x07\u202egnp\u2028\x9b31m [/bold] [red]"


def test_what_a_terminal_obeys_becomes_an_escape() -> None:
    assert printable(EVIL) == SHOWN
    assert printable("Größe 3 µm, 測定\n\tnext") == "Größe 3 µm, 測定\n\tnext"
    assert printable("one\nline", kept="") == r"one\nline"


def test_tables_and_texts_show_names_as_they_are() -> None:
    table = Table(title=EVIL)
    table.add_column(EVIL)
    table.add_row(EVIL)
    table.add_row(Text(EVIL))
    for shown in (table, EVIL, Text(EVIL)):
        text = plain_text(shown)
        assert r"\x1b[2J\x1b]0;ti" in text
        assert "[/bold] [red]" in text
        assert all(each.isprintable() for each in text.replace("\n", ""))


def test_colours_of_our_own_remain() -> None:
    lines = io.StringIO()
    console = TextConsole(file=lines, force_terminal=True, color_system="standard", width=200)
    console.print(Text("warning: \x1b[2J", style="yellow"))
    assert lines.getvalue() == "\x1b[33mwarning: \\x1b[2J\x1b[0m\n"


@pytest.mark.parametrize("arguments", [("plan", "check", "{plan}"), ("model", "new", "{machine}", "-o", "m.toml")])
def test_commands_print_no_control_characters_of_files(tmp_path: Path, arguments: tuple[str, ...]) -> None:
    folder = tmp_path / "a\x1b[31m"
    folder.mkdir()
    machine, plan = folder / "machine.toml", folder / "plan.toml"
    name = 'name = "\\u001B[2J\\u0007 */ int evil = 1; /*"'
    lines = shipped("sp120.toml").read_text().splitlines()
    machine.write_text("\n".join(name if line.startswith("name = ") else line for line in lines))
    plan.write_text(
        shipped("plans", "thesis.toml").read_text().replace('machine = "sp120"', 'machine = "machine.toml"')
    )
    command = [each.format(plan=plan, machine=machine) for each in arguments]
    for wrong in (False, True):
        if wrong:
            machine.write_text(machine.read_text().replace("length_mm = 400.0", "length_mm = -400.0"))
        (tmp_path / "m.toml").unlink(missing_ok=True)
        done = called("hexdbb", *command, folder=tmp_path)
        assert done.returncode == (2 if wrong else 0), done.stderr
        assert "\x1b" not in done.stdout + done.stderr
        assert "\x07" not in done.stdout + done.stderr
        assert not wrong or r"a\x1b[31m" in done.stderr


def test_notebooks_show_names_as_they_are(record: Record) -> None:
    evil = "<script>alert(1)</script>&"
    machine = record.machine.model_copy(update={"name": evil})
    named = replace(record, path=Path(evil), columns={**record.columns, evil: record.columns["t_s"]})
    step = LedgerStep(1, "diagnose", 2.0, 1.0, (evil,))
    for shown in (machine, named, Samples.of([named]), History((step,))):
        html = shown._repr_html_()
        assert "<script" not in html
    assert "&lt;script&gt;" in named._repr_html_()


def test_pictures_show_a_dollar_sign_as_it_is(tmp_path: Path) -> None:
    figure = Figure()
    figure.suptitle(r"a$\frac{$ of b$ \x1b[2J")
    figure.subplots().set_xscale("log")
    (written,) = save_figure(figure, tmp_path / "a", (".svg",))
    assert r"a$\frac{$ of b$ \x1b[2J" in written.read_text()
    assert "mathdefault{10^{0}}$<" not in written.read_text(), "powers remain formulas"
