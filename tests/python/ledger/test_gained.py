"""Model files of a version in which an effect had one shape less: the shape is at its start, and steps are undone."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hexdbb.errors import InputError
from hexdbb.files.validation import dump_toml, load_toml
from hexdbb.ledger import undo
from hexdbb.machine import shipped_machine
from hexdbb.model import load_model, new_model, save_model
from hexdbb.model.entries import ModelFile
from hexdbb.model.gained import with_gained_shape
from hexdbb.model.ledger import LedgerStep

EFFECT, GAINED = "reversal_spike", "log_travel"
INFO = new_model(shipped_machine(), [EFFECT]).info(EFFECT)


def written_before(path: Path) -> Path:
    """Take from a model file what the effect has gained, from its values and from those of earlier steps."""
    file = load_toml(path, ModelFile)
    kept = [index for index, each in enumerate(INFO.parameters * len(INFO.elements)) if each.name != GAINED]
    effects = tuple(
        each.model_copy(update={"parameters": tuple(e for e in each.parameters if e.name != GAINED)})
        for each in file.effects
    )
    earlier = tuple(
        entry.model_copy(
            update={
                "effects": tuple(
                    each.model_copy(
                        update={
                            key: tuple(values[place] for place in kept)
                            for key in ("values", "sigma", "identifiable", "free")
                            if (values := getattr(each, key)) is not None
                        }
                    )
                    for each in entry.effects
                )
            }
        )
        for entry in file.earlier
    )
    path.write_text(dump_toml(file.model_copy(update={"effects": effects, "earlier": earlier})))
    return path


@pytest.fixture
def old(tmp_path: Path) -> Path:
    model = new_model(shipped_machine(), [EFFECT])
    values = np.arange(len(model.values), dtype=float) * 1e-3
    free = np.array([each.element in ("1", "4") for each in model.parameters()])
    before = model.with_values(2.0 * values).with_free(free)
    now = before.with_values(values)
    step = LedgerStep(1, "diagnose", 2.0, 1.0, ("record",), before=before.snapshot)
    save_model(replace(now, ledger=(step,)), tmp_path / "model.toml")
    return written_before(tmp_path / "model.toml")


def test_what_an_effect_has_gained_is_at_its_start_and_free_where_its_element_is(old: Path) -> None:
    assert GAINED not in old.read_text()
    model = load_model(old)
    names = np.array([each.name for each in model.parameters()])
    expected = np.where(names == GAINED, 0.0, np.arange(len(names)) * 1e-3)
    assert model.values == pytest.approx(expected)
    assert [each.element for each, is_free in zip(model.parameters(), model.free, strict=True) if is_free] == [
        *["1"] * 3,
        *["4"] * 3,
    ]


def test_a_step_of_before_can_be_undone(old: Path) -> None:
    model = undo(load_model(old))
    names = np.array([each.name for each in model.parameters()])
    assert model.values == pytest.approx(np.where(names == GAINED, 0.0, np.arange(len(names)) * 2e-3))


def test_other_numbers_of_values_are_an_error(old: Path) -> None:
    text = old.read_text()
    first = text.index("[[effect.parameter]]")
    second = text.index("[[effect.parameter]]", first + 1)
    old.write_text(text[:first] + text[second:])
    with pytest.raises(InputError, match=r"parameter: 11 entries \(expected 18\)"):
        load_model(old)


@given(st.lists(st.integers(), max_size=40))
def test_only_what_lacks_one_shape_everywhere_is_changed(numbers: list[int]) -> None:
    found = with_gained_shape(numbers, INFO, lambda element, last: last)
    if len(numbers) == 12:
        assert found[::3] == numbers[::2] and found[1::3] == found[2::3] == numbers[1::2]
    else:
        assert found == numbers
