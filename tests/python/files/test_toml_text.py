"""The TOML writer against tomlkit, whose form files and content hashes have."""

from __future__ import annotations

import tomlkit
from hypothesis import given, settings
from hypothesis import strategies as st

from hexdbb.files.toml_text import toml_text
from hexdbb.machine import shipped_machine
from hexdbb.model import Choice, new_model, save_model
from hexdbb.plan import load_plan

plain = st.booleans() | st.integers(-(10**12), 10**12) | st.floats() | st.text(max_size=6)
values = plain | st.lists(plain, max_size=3) | st.lists(st.lists(plain, max_size=2), max_size=2)
keys = st.sampled_from(["a", "b_mm", "c-1", "d", "e", "f", "with space", "ä"])


def tables(inner):
    return st.dictionaries(keys, values | inner | st.lists(inner, max_size=3), max_size=5)


nested = tables(tables(tables(st.dictionaries(keys, values, max_size=2))))


@settings(max_examples=300, deadline=None)
@given(nested)
def test_any_content_has_the_form_of_tomlkit(content):
    assert toml_text(content) == tomlkit.dumps(content)


def test_machine_plan_and_model_are_written_without_it(tmp_path, monkeypatch):
    machine, plan = shipped_machine(), load_plan("standard")
    expected = [tomlkit.dumps(_content(each)) for each in (machine, plan)]
    monkeypatch.setattr(tomlkit, "dumps", None)
    assert [toml_text(_content(each)) for each in (machine, plan)] == expected
    path = tmp_path / "model.toml"
    save_model(new_model(machine).with_effect(Choice("backlash")), path)
    monkeypatch.undo()
    assert tomlkit.dumps(tomlkit.parse(path.read_text()).unwrap()) == path.read_text()


def _content(file):
    content = file.model_dump(by_alias=True, exclude_none=True)
    return {key: value for key, value in content.items() if value != {}}
