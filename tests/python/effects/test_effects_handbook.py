"""The handbook says what the code says; its pictures are those of every effect; the command lists them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from hexdbb import _core
from hexdbb.cli.effects import command
from hexdbb.effects.handbook import INDEX, handbook

FOLDER = Path(__file__).parents[3] / "docs" / "effects"
CATALOGUE = [
    "backlash",
    "reversal_spike",
    "pitch_cyclic",
    "lead_error",
    "straightness",
    "servo_lag",
    "leg_thermal",
    "screw_thermal",
    "gravity_sag",
    "joint_offset",
    "joint_friction",
    "bar_drift",
    "bar_gain",
    "sample_delay",
    "ball_eccentricity",
]
PLACES = ["ball_rotation"]


def test_names_are_the_interface() -> None:
    assert list(_core.effect_names("catalogue")) == CATALOGUE
    assert list(_core.effect_names("places")) == PLACES
    assert len(_core.effect_names()) == 7 + 3 + len(PLACES) + len(CATALOGUE)


@pytest.mark.parametrize("name", sorted(handbook()))
def test_committed_page_is_that_of_the_code(name: str) -> None:
    committed = (FOLDER / name).read_text(encoding="utf-8")
    assert committed == handbook()[name], "run `hexdbb effects handbook -o docs/effects`"


def test_nothing_stands_in_the_folder_that_no_effect_has() -> None:
    assert {path.name for path in FOLDER.glob("*.md")} == set(handbook())
    assert {path.stem for path in (FOLDER / "images").glob("*.png")} == set(_core.effect_names())
    assert all(f"({name}.md)" in handbook()[INDEX] for name in _core.effect_names())


def test_command_writes_the_handbook(tmp_path: Path) -> None:
    done = CliRunner().invoke(command, ["handbook", "-o", str(tmp_path / "new")])
    assert done.exit_code == 0, done.output
    assert (tmp_path / "new" / INDEX).read_text(encoding="utf-8") == handbook()[INDEX]
    images = list((tmp_path / "new" / "images").glob("*.png"))
    assert len(images) == len(_core.effect_names())
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in images)


def test_command_lists_own_effects_beside_the_others(tmp_path: Path) -> None:
    mine = tmp_path / "mine.py"
    mine.write_text(
        "from hexdbb.effects import effect\n\n\n@effect(port='leg', unit='mm', prior_sigma=0.01, elements=6)\n"
        "def creak(state):\n    '''Legs creak.'''\n    return state.leg_force\n"
    )
    done = CliRunner().invoke(command, ["--json", "--effects", str(mine)])
    assert done.exit_code == 0, done.output
    listed = json.loads(done.stdout)["effects"]
    assert [each["effect"] for each in listed] == [*_core.effect_names(), "creak"]
    assert listed[-1]["physics"] == "Legs creak." and listed[-1]["group"] == "user"
    assert "creak" in CliRunner().invoke(command, ["--effects", str(mine)]).stdout
