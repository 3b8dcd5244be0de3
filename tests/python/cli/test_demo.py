"""`hexdbb demo`: its story is commands that exist; a folder in use is refused; a command that fails ends it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import click
import pytest
from tests.programs import called

from hexdbb.cli import cli
from hexdbb.cli.demo import arguments_of
from hexdbb.cli.demo_story import CHAPTERS, Chapter, Fault
from hexdbb.cli.run import command as hexdbb_run

LINES = [
    line
    for chapter in CHAPTERS
    for line in (*(step for steps in chapter.stages.values() for step in steps), *chapter.by_hand)
    if not isinstance(line, Fault)
]


@pytest.mark.parametrize("line", LINES)
def test_commands_of_the_story_have_these_options(line: str) -> None:
    program, *arguments = arguments_of(line, Path("a folder"), 20.0)
    command: click.Command | None = hexdbb_run
    if program == "hexdbb":
        command = cli.get_command(click.Context(cli), arguments.pop(0))
    assert command is not None
    context = command.make_context("command", arguments)
    assert any(str(value).startswith("a folder/") for value in _flat(context.params.values()))


def _flat(values: Iterable[object]) -> list[object]:
    return [each for value in values for each in (value if isinstance(value, tuple) else (value,))]


MEASURED = Chapter(
    {
        "A machine": (
            "hexdbb rig --seed 11 --write-truth {folder}/hidden.toml --no-serve",
            Fault("hidden.toml", '[[mechanism]]\nkind = "backlash"\nslider = 4\nwidth_um = 15.0\n'),
        ),
        "Read again": ("hexdbb rig --truth {folder}/hidden.toml --write-truth {folder}/again.toml --no-serve",),
    },
    ("hexdbb plan check standard",),
)
ENDS = Chapter({"One": ("hexdbb history -m {folder}/none.toml",), "Two": ("hexdbb effects",)})
SERVES = Chapter({"One": ("hexdbb rig",)})


def told(chapter: Chapter, folder: Path, **options: Any) -> subprocess.Popen[str]:
    """Start the demo with a story of its own."""
    story = f"from hexdbb.cli.demo_story import Chapter, Fault; from hexdbb.cli import demo; demo.HIDDEN = {chapter!r}"
    obeyed = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)"
    line = f"{obeyed}; {story}; from hexdbb_start import hexdbb; hexdbb()"
    words = [sys.executable, "-c", line, "demo", "there"]
    return subprocess.Popen(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)


def test_tells_each_command_before_it_runs(tmp_path: Path) -> None:
    demo = told(MEASURED, tmp_path)
    out, err = demo.communicate(timeout=120)
    assert (demo.returncode, err) == (0, "")
    headings = [line for line in out.splitlines() if line.startswith("==")]
    assert headings == ["== 1/2  A machine", "== 2/2  Read again"]
    assert out.index("$ hexdbb rig --seed 11") < out.index("$ cat >> there/hidden.toml") < out.index("== 2/2")
    assert 'kind = "backlash"' in (tmp_path / "there" / "again.toml").read_text(encoding="utf-8")
    assert out.splitlines()[-4:-2] == ["  again.toml", "  hidden.toml"]
    assert out.splitlines()[-1] == "  hexdbb plan check standard"


def test_a_command_that_fails_ends_it(tmp_path: Path) -> None:
    demo = told(ENDS, tmp_path)
    out, err = demo.communicate(timeout=120)
    assert demo.returncode == 1
    assert err.splitlines()[-1] == "error: the demo ends here: hexdbb history ended with exit status 2"
    assert "== 2/2" not in out


def test_ctrl_c_ends_the_command_too(tmp_path: Path) -> None:
    demo = told(SERVES, tmp_path, start_new_session=True)
    assert demo.stdout is not None
    assert any(line.startswith("hexdbb rig: listening") for line in demo.stdout)
    os.killpg(demo.pid, signal.SIGINT)
    _, err = demo.communicate(timeout=60)
    assert demo.returncode == 130
    assert "Traceback" not in err


def test_a_folder_in_use_is_refused(tmp_path: Path) -> None:
    (tmp_path / "hexdbb-demo").mkdir()
    (tmp_path / "hexdbb-demo" / "mine.parquet").touch()
    (tmp_path / "file").touch()
    for words in ([], ["file"]):
        done = called("hexdbb", "demo", *words, folder=tmp_path)
        assert (done.returncode, done.stdout) == (2, "")
        name = (words or ["hexdbb-demo"])[0]
        assert done.stderr == f"error: {name}: exists already (expected a folder that is empty or new)\n"
