"""A draft of the main cause: a file that loads, pushes what was learned, and says what it was made of."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path

import pytest

import hexdbb as hx
from hexdbb.discovery import Discovery, discover
from hexdbb.model import new_model
from hexdbb.record import Record
from hexdbb.samples import Samples

Measured = Callable[[str], Record]


@pytest.fixture(scope="module")
def looked(measured: Measured) -> Callable[[str], Discovery]:
    """Return what was discovered of a case, by its name."""

    @lru_cache
    def look(name: str) -> Discovery:
        record = measured(name)
        return discover(Samples.of([record]), new_model(record.machine))

    return look


def test_the_main_cause_is_drafted_as_it_was_learned(looked: Callable[[str], Discovery], tmp_path: Path) -> None:
    found = looked("dent-x3-s1")
    drafted = hx.draft_effect(found, tmp_path / "mine.py")
    assert drafted.name == found.causes[0].choice
    assert drafted.sentence == f"{drafted.name}, the main cause"
    assert (tmp_path / "mine.py").read_text() == drafted.source
    (mine,) = hx.load_effects(tmp_path / "mine.py")
    model = found.base.knowing_effects([mine])
    fitted = hx.add_effect(found.samples, model, mine.name)
    # A bump stands for what was learned point by point: most of it, not all.
    assert fitted.rms_after_um < 0.5 * found.rms_before_um


def test_beside_a_known_cause_the_best_learned_function_is_drafted(
    looked: Callable[[str], Discovery], tmp_path: Path
) -> None:
    drafted = hx.draft_effect(looked("backlash-x3-s1"), tmp_path / "mine.py")
    assert drafted.name.startswith("learned:slider:4:")
    assert drafted.sentence == f"{drafted.name}, the best learned function; the main cause is backlash:4"
    assert [each.name for each in hx.load_effects(tmp_path / "mine.py")] == [drafted.name.replace(":", "_")]


def test_no_draft_where_nothing_is_missing(looked: Callable[[str], Discovery], tmp_path: Path) -> None:
    with pytest.raises(hx.RunError, match="no effect to draft: nothing is missing"):
        hx.draft_effect(looked("none-s1"), tmp_path / "mine.py")
    assert list(tmp_path.iterdir()) == []


def test_an_existing_file_is_kept(looked: Callable[[str], Discovery], tmp_path: Path) -> None:
    place = tmp_path / "mine.py"
    place.write_text("kept")
    with pytest.raises(hx.InputError, match=r"mine\.py: exists already"):
        hx.draft_effect(looked("backlash-x3-s1"), place)
    with pytest.raises(hx.InputError, match=r"mine\.txt: cannot hold an effect \(expected the name of a Python file"):
        hx.draft_effect(looked("backlash-x3-s1"), tmp_path / "mine.txt")
    assert place.read_text() == "kept"
    hx.draft_effect(looked("backlash-x3-s1"), place, overwrite=True)
    assert place.read_text() != "kept"
