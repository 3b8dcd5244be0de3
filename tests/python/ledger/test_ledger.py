"""Effects added, taken away and undone: the file stands alone, every step can be taken back, the ledger reads aloud."""

from __future__ import annotations

import json
import re
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.programs import called

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.ledger import add_effect, fit_model, history, remove_effect, undo
from hexdbb.machine import shipped_machine
from hexdbb.model import Choice, Model, Term, load_model, new_model, save_model
from hexdbb.model.shown import engine_values, shown_values
from hexdbb.record import Record, write_record
from hexdbb.rig.truth import random_truth
from hexdbb.samples import Samples
from hexdbb_truth.cases import case
from hexdbb_truth.plans import discovery_plan
from hexdbb_truth.simulate import Pace, simulate

SEED = 11
HIDDEN, ELEMENT = "guideway_rotation_yz", "2"
"""What the model of these tests lacks: level circles see a guideway's tilt well."""
PACE = Pace(rate_hz=1.0, instants_per_sample=1, travel_s=1.0)


@pytest.fixture(scope="module")
def record() -> Record:
    return simulate(random_truth(SEED), discovery_plan().model_copy(update={"laps": 1}), pace=PACE)


@pytest.fixture(scope="module")
def without(record: Record) -> Model:
    """Return a fitted model that lacks an effect."""
    names = [name for name in _core.effect_names() if new_model(record.machine, [name]).info(name).is_set_up]
    geometry = ["leg_length", "slider_offset", "guideway_translation", "guideway_rotation_xy", "platform_side"]
    chosen = geometry + [name for name in names if name in ("cup_position", "ball_offset")]
    return fit_model(Samples.of([record]), new_model(record.machine, chosen)).model


@pytest.fixture(scope="module")
def added(record: Record, without: Model) -> Model:
    return add_effect(Samples.of([record]), without, HIDDEN).model


def saved(model: Model, folder: Path) -> str:
    save_model(model, folder / "written.toml")
    return (folder / "written.toml").read_text()


def value(model: Model, label: str) -> float:
    return next(v for p, v in zip(model.parameters(), model.values, strict=True) if p.label.startswith(label))


def test_a_missing_effect_added_lets_the_error_fall_where_it_was_not_fitted(without: Model, added: Model) -> None:
    step = added.ledger[-1]
    assert (step.what, step.effect, step.elements, step.element_kind) == ("add", HIDDEN, (), "guideway")
    assert step.rms_before_um == pytest.approx(without.ledger[-1].rms_after_um, rel=1e-3)
    assert step.rms_after_um < 0.7 * step.rms_before_um
    assert step.heldout_after_um < 0.7 * step.heldout_before_um
    assert step.rms_after_um <= step.heldout_after_um
    assert step.rms_before_um <= step.heldout_before_um
    for before, after in (
        (step.peak_to_valley_before_um, step.peak_to_valley_after_um),
        (step.heldout_peak_to_valley_before_um, step.heldout_peak_to_valley_after_um),
    ):
        assert before > after > 2.0 * step.rms_after_um
    assert [size.element for size in step.sizes] == ["1", "2", "3"]
    assert {size.unit for size in step.sizes} == {"urad"}


def test_the_diagnosis_of_an_addition_is_compared_with_the_model_without_it(record: Record, without: Model) -> None:
    found = add_effect(Samples.of([record]), without, HIDDEN)
    changed = found.model
    step = changed.ledger[-1]
    assert found.model is changed
    assert found.rms_before_um == pytest.approx(step.rms_before_um)
    assert found.rms_after_um == pytest.approx(step.rms_after_um)
    assert found.held_out.before_um == pytest.approx(step.heldout_before_um)
    assert step.records == (record.name,)
    assert step.record_hashes == (record.content_hash(),)


def test_only_the_elements_chosen_are_free_and_more_can_be_added() -> None:
    model = new_model(shipped_machine(), ["cup_position"])
    one = model.with_effect(Choice.parse(f"{HIDDEN}:2"))
    assert [p.label for p, free in zip(one.parameters(), one.free, strict=True) if free][3:] == [f"{HIDDEN}:2 angle"]
    two = one.with_effect(Choice.parse(f"{HIDDEN}:1:2"))
    assert two.terms[-1].free.tolist() == [True, True, False]
    whole = two.with_effect(Choice.parse(HIDDEN))
    assert whole.terms[-1].free.all()
    assert len(whole.terms) == 2


def test_elements_not_chosen_stay_zero(record: Record, without: Model) -> None:
    changed = add_effect(Samples.of([record]), without, f"{HIDDEN}:{ELEMENT}").model
    assert value(changed, f"{HIDDEN}:{ELEMENT}") != 0.0
    assert value(changed, f"{HIDDEN}:1") == value(changed, f"{HIDDEN}:3") == 0.0
    assert changed.ledger[-1].elements == (ELEMENT,)
    assert len(changed.ledger[-1].sizes) == 1


def test_an_effect_can_be_added_to_a_machine_without_any(record: Record) -> None:
    found = add_effect(Samples.of([record]), new_model(record.machine, []), "cup_position")
    changed = found.model
    step = changed.ledger[-1]
    assert step.rms_after_um < step.rms_before_um == pytest.approx(step.heldout_before_um)
    assert found.rank == 0 and len(changed.mounts) == 1


def test_elements_that_only_the_records_have_can_be_added(record: Record) -> None:
    again = simulate(random_truth(SEED), discovery_plan().model_copy(update={"laps": 1}), seed=1, pace=PACE)
    fresh = new_model(record.machine, ["cup_position"])
    changed = add_effect(Samples.of([record, again]), fresh, "ball_eccentricity:2").model
    free = changed.terms[-1].free
    assert changed.terms[-1].effect == "ball_eccentricity"
    info = changed.info("ball_eccentricity")
    assert free.sum() == len(info.parameters) and len(free) == info.size == len(info.parameters) * 2


def test_removing_an_effect_takes_it_out_and_says_what_it_was(record: Record, without: Model, added: Model) -> None:
    removed = remove_effect(Samples.of([record]), added, HIDDEN).model
    assert [term.effect for term in removed.terms] == [term.effect for term in without.terms]
    step = removed.ledger[-1]
    assert step.what == "remove"
    assert step.rms_after_um == pytest.approx(added.ledger[-1].rms_before_um, rel=1e-3)
    assert step.sizes[1].value == pytest.approx(1e6 * value(added, f"{HIDDEN}:2"), rel=1e-3)


def test_an_element_taken_away_is_held_at_zero_and_the_last_takes_the_effect() -> None:
    model = new_model(shipped_machine(), ["cup_position"]).with_effect(Choice.parse(f"{HIDDEN}:1:2"))
    left = model.without_effect(Choice.parse(f"{HIDDEN}:1"))
    assert left.terms[-1].free.tolist() == [False, True, False]
    assert [term.effect for term in left.without_effect(Choice.parse(f"{HIDDEN}:2")).terms] == ["cup_position"]


def test_steps_are_taken_back_one_by_one_from_the_file_alone(
    record: Record, without: Model, added: Model, tmp_path: Path
) -> None:
    states = [new_model(record.machine, [term.effect for term in without.terms]), without, added]
    states.append(remove_effect(Samples.of([record]), added, f"{HIDDEN}:1").model)
    texts = [saved(state, tmp_path) for state in states]
    assert len(set(texts)) == len(texts)
    (tmp_path / "model.toml").write_text(texts[-1])
    for expected in reversed(texts[:-1]):
        save_model(undo(load_model(tmp_path / "model.toml")), tmp_path / "model.toml")
        assert (tmp_path / "model.toml").read_text() == expected
    with pytest.raises(InputError, match=r"model\.toml: nothing to undo"):
        undo(load_model(tmp_path / "model.toml"))


def test_a_file_read_and_written_is_the_same_file(added: Model, tmp_path: Path) -> None:
    text = saved(added, tmp_path)
    again = load_model(tmp_path / "written.toml")
    assert saved(again, tmp_path) == text
    assert again.values == pytest.approx(added.values, rel=1e-14, abs=0.0)
    assert again.ledger == added.ledger
    assert 'what = "add"' in text and f'effect = "{HIDDEN}"' in text


@given(st.lists(st.floats(-1e4, 1e4, allow_subnormal=False), max_size=8), st.sampled_from(["mm", "rad", "mm/N", "1"]))
def test_values_settle_in_the_unit_shown(values: list[float], unit: str) -> None:
    units = [unit] * len(values)
    shown = shown_values(np.array(values), units)
    assert shown_values(engine_values(shown, units), units) == shown
    assert engine_values(shown, units) == pytest.approx(np.array(values), rel=1e-14)


def test_a_step_whose_earlier_state_is_gone_cannot_be_undone(added: Model, tmp_path: Path) -> None:
    last = replace(added.ledger[-1], before=None)
    save_model(replace(added, ledger=(*added.ledger[:-1], last)), tmp_path / "model.toml")
    with pytest.raises(InputError, match=r"step 2 \(add\) cannot be undone: the model before it was not kept"):
        undo(load_model(tmp_path / "model.toml"))


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("before_step = 1\nmounts = 0", "before_step = 1\nmounts = 9", r"earlier\[0\].mounts: 9 \(expected at most 1"),
        ("before_step = 1\n", "before_stop = 1\n", r"earlier\[0\].before_stop: unknown key \(expected before_step\)"),
        ('name = "cup_position"\nvalues = [', 'name = "cup_position"\nvalues = [7.0, ', r"4 values \(expected 3"),
        (
            '[[earlier.effect]]\nname = "leg_length"',
            '[[earlier.effect]]\nname = "leg"',
            r"earlier\[0\].effect\[0\].name",
        ),
    ],
)
def test_a_damaged_earlier_state_is_named(added: Model, tmp_path: Path, old: str, new: str, words: str) -> None:
    text = saved(added, tmp_path)
    assert old in text
    (tmp_path / "model.toml").write_text(text.replace(old, new, 1))
    with pytest.raises(InputError, match=words):
        load_model(tmp_path / "model.toml")


def test_the_ledger_reads_aloud(added: Model) -> None:
    first, second = history(added).text.splitlines()
    number = r"-?\d+\.\d+"
    assert re.match(rf"step 1: fitted the values; reading error {number} -> {number} µm RMS \(peak to valley", first)
    size = rf"angle {number} (± {number} µrad|µrad, known only in combination with others)"
    assert re.match(rf"step 2: added {HIDDEN} \(1 {size}; 2 {size}; 3 {size}\); reading error", second)
    assert re.search(rf"held-out circles {number} -> {number} µm RMS", second)
    data = history(added).to_json()["steps"][1]
    assert data["sentence"] == second
    assert json.loads(json.dumps(data, allow_nan=False)) == data
    assert data["sizes"][0]["unit"] == "urad"
    assert f"<td>added {HIDDEN}" in history(added)._repr_html_()


@pytest.mark.parametrize(
    ("choice", "words"),
    [
        ("backlahs:4", "backlahs.*leg_length"),
        ("slider_offset:7", r'slider_offset:7: slider_offset has no element "7" \(expected one of 1, 2, 3, 4, 5, 6\)'),
        ("slider_offset:1:2", "slider_offset:1:2: the model has it already, free to be fitted"),
        ("slider_offset", "slider_offset: the model has it already"),
    ],
)
def test_what_cannot_be_added_is_named(record: Record, without: Model, choice: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        add_effect(Samples.of([record]), without, choice)


def test_what_is_not_there_cannot_be_removed(record: Record, without: Model) -> None:
    with pytest.raises(InputError, match=rf"{HIDDEN}: not in the model \(expected one of leg_length"):
        remove_effect(Samples.of([record]), without, HIDDEN)


def test_record_and_model_of_different_machines_are_refused(record: Record, without: Model) -> None:
    legs = record.machine.legs.model_copy(update={"length_mm": 401.0})
    other = replace(record, machine=record.machine.model_copy(update={"legs": legs}))
    with pytest.raises(InputError, match=r"legs\.length_mm: 400 \(expected 401.*do not belong together"):
        add_effect(Samples.of([other]), without, HIDDEN)


def test_a_held_value_is_freed_not_refused(without: Model) -> None:
    term = without.terms[0]
    held = Term(term.effect, np.zeros(6, bool), term.values, term.sigma, term.identifiable)
    model = replace(without, terms=(held, *without.terms[1:]))
    freed = model.with_effect(Choice.parse("leg_length:3"))
    assert freed.terms[0].free.tolist() == [False, False, True, False, False, False]
    assert np.array_equal(freed.terms[0].values, term.values)


def hexdbb(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    return called("hexdbb", *words, folder=folder)


def test_the_commands_add_read_aloud_and_undo(record: Record, without: Model, tmp_path: Path) -> None:
    write_record(record, tmp_path / "today.parquet")
    save_model(without, tmp_path / "model.toml")
    before = (tmp_path / "model.toml").read_bytes()
    done = hexdbb(tmp_path, "add", f"{HIDDEN}:1:2:3", "-m", "model.toml", "today.parquet")
    assert done.returncode == 0, done.stderr
    number = r"\d+\.\d\d"
    fall = rf"{number} µm -> {number} µm \(held-out circles {number} -> {number}\)"
    assert re.fullmatch(fall, done.stdout.splitlines()[0])
    assert re.search(rf"^{HIDDEN} +1 +angle +-?{number} +({number}|~) +µrad$", done.stdout, flags=re.MULTILINE)
    told = hexdbb(tmp_path, "history", "-m", "model.toml")
    assert told.stdout == history(load_model(tmp_path / "model.toml")).text + "\n"
    data = json.loads(hexdbb(tmp_path, "history", "-m", "model.toml", "--json").stdout)
    assert [step["what"] for step in data["steps"]] == ["diagnose", "add"]
    undone = hexdbb(tmp_path, "undo", "-m", "model.toml")
    assert f"added {HIDDEN} of guideways 1, 2 and 3" in undone.stdout
    assert (tmp_path / "model.toml").read_bytes() == before
    taken = json.loads(hexdbb(tmp_path, "undo", "-m", "model.toml", "--json").stdout)
    assert taken["steps_left"] == 0 and taken["undone"]["what"] == "diagnose"


def test_add_prints_one_json_object(record: Record, without: Model, tmp_path: Path) -> None:
    write_record(record, tmp_path / "today.parquet")
    save_model(without, tmp_path / "model.toml")
    done = hexdbb(tmp_path, "add", HIDDEN, "-m", "model.toml", "today.parquet", "--json")
    data = json.loads(done.stdout)
    assert data["effect"] == HIDDEN and data["rms_after_um"] < data["rms_before_um"]
    assert data["heldout_after_um"] < data["heldout_before_um"]
    assert {"element", "name", "value", "sigma", "unit"} == set(data["sizes"][0])
    assert isinstance(data["warnings"], list)


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("add nothing_known -m model.toml today.parquet", "nothing_known"),
        (f"add {HIDDEN}:9 -m model.toml today.parquet", 'has no element "9"'),
        ("add leg_length -m model.toml today.parquet", "model.toml has it already"),
        (f"add {HIDDEN} -m absent.toml today.parquet", "absent.toml: no such model"),
        (f"add {HIDDEN} -m model.toml absent.parquet", "absent.parquet: no such file"),
        ("undo -m fresh.toml", "fresh.toml: nothing to undo"),
        ("undo -m absent.toml", "absent.toml: no such model"),
        ("history -m absent.toml", "absent.toml: no such model"),
    ],
)
def test_wrong_use_is_one_line_and_changes_nothing(
    record: Record, without: Model, tmp_path: Path, line: str, words: str
) -> None:
    write_record(record, tmp_path / "today.parquet")
    save_model(without, tmp_path / "model.toml")
    save_model(new_model(record.machine), tmp_path / "fresh.toml")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    done = hexdbb(tmp_path, *line.split())
    assert (done.returncode, done.stdout) == (2, "")
    assert len(done.stderr.strip().splitlines()) == 1
    assert words in done.stderr
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_a_hidden_mechanism_of_the_catalogue_is_added_and_the_error_falls_to_the_noise() -> None:
    hidden = case("backlash-x10-s0")
    (fault,) = hidden.hidden
    record = hidden.record()
    samples = Samples.of([record])
    found = add_effect(samples, fit_model(samples, new_model(record.machine)).model, f"backlash:{fault.element}")
    model = found.model
    step = model.ledger[-1]
    noise_um = found.noise.sigma_mm * 1e3
    assert step.rms_before_um > 5.0 * noise_um
    assert step.heldout_before_um > 5.0 * noise_um
    assert step.rms_after_um < step.heldout_after_um < 1.2 * noise_um
    (size,) = step.sizes
    assert size.value == pytest.approx(fault.mechanism.width_um, abs=0.5)
    assert 0.0 < size.sigma < 0.5
    assert f"added backlash of slider {fault.element} (play" in history(model).text.splitlines()[-1]
