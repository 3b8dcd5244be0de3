"""The truth file, the random machine, the mechanisms."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from hexdbb.errors import InputError
from hexdbb.files.validation import dump_toml, load_toml
from hexdbb.rig.mechanisms import MECHANISMS
from hexdbb.rig.truth import TruthFile, random_truth

HEAD = 'schema = "hexdbb.truth/1"\n'


def test_random_machine_is_the_seeds_and_survives_its_file(tmp_path):
    truth = random_truth(4)
    assert truth == random_truth(4)
    assert truth != random_truth(5)
    path = tmp_path / "truth.toml"
    path.write_text(dump_toml(truth), encoding="utf-8")
    assert load_toml(path, TruthFile) == truth


def test_random_machine_has_the_stated_sizes():
    errors = [random_truth(seed).geometry.errors() for seed in range(60)]
    for name, sigma in (("leg_length_mm", 0.05), ("guideway_rotation_yz_rad", 2e-4), ("platform_side_mm", 0.03)):
        spread = np.std([getattr(e, name) for e in errors])
        assert spread == pytest.approx(sigma, rel=0.2)


def test_units_are_converted_once():
    truth = TruthFile.model_validate(
        {
            "schema": "hexdbb.truth/1",
            "geometry": {"leg_length_um": [50.0, 0, 0, 0, 0, 0], "guideway_rotation_xy_urad": [0, 200.0, 0]},
            "setup": {"cup_error_um": [[1.0, 2.0, 3.0]], "bar_length_error_um": 4.0},
        }
    )
    assert truth.geometry.errors().leg_length_mm[0] == pytest.approx(0.05)
    assert truth.geometry.errors().guideway_rotation_xy_rad[1] == pytest.approx(2e-4)
    assert truth.setup.errors().cup_mm[0] == pytest.approx((1e-3, 2e-3, 3e-3))
    assert truth.setup.errors().bar_length_mm == pytest.approx(4e-3)


def test_mechanisms_survive_the_file(tmp_path, truth_file):
    path = truth_file(
        '[[mechanism]]\nkind = "backlash"\nslider = 3\nwidth_um = 8.0\n'
        '[[mechanism]]\nkind = "bar_drift"\nrate_um_min = 1.5\n'
    )
    truth = load_toml(path, TruthFile)
    assert [table.kind for table in truth.mechanism] == ["backlash", "bar_drift"]
    again = tmp_path / "again.toml"
    again.write_text(dump_toml(truth), encoding="utf-8")
    assert load_toml(again, TruthFile) == truth


def test_mechanism_can_be_appended_to_a_written_truth(truth_file):
    written = dump_toml(random_truth(3)).removeprefix('schema = "hexdbb.truth/1"\n')
    path = truth_file(written + '\n[[mechanism]]\nkind = "backlash"\nslider = 4\nwidth_um = 15.0\n')
    truth = load_toml(path, TruthFile)
    assert [table.kind for table in truth.mechanism] == ["backlash"]
    assert truth.geometry == random_truth(3).geometry


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (
            '[[mechanism]]\nkind = "gremlin"',
            'mechanism[0].kind: "gremlin" (expected one of backlash, reversal_spike, pitch_cyclic, ',
        ),
        ('[[mechanism]]\nkind = "backlash"\nslider = 7\nwidth_um = 8.0', "mechanism[0].slider: 7 (expected backlash: "),
        ('[[mechanism]]\nkind = "backlash"\nslider = 1', "mechanism[0].width_um"),
        ("[geometry]\nleg_length_mm = [0, 0, 0, 0, 0, 0]", "leg_length_um: the unit is part of the key"),
        ("[drive]\nlag_s = 0.0", "drive.lag_s: 0 (expected a number > 0)"),
        ("[gauge]\nnoise_um = nan", "gauge.noise_um"),
    ],
)
def test_bad_values_are_named_with_file_and_key(truth_file, content, says):
    path = truth_file(content)
    with pytest.raises(InputError) as error:
        load_toml(path, TruthFile)
    assert str(error.value).startswith(f"{path}: ")
    assert says in str(error.value)
    assert "\n" not in str(error.value)


def test_every_registered_mechanism_is_named_by_its_kind():
    for kind, table in MECHANISMS.items():
        assert table.model_fields["kind"].annotation.__args__ == (kind,)


def test_example_of_the_manual_loads(tmp_path):
    manual = (Path(__file__).parents[3] / "docs" / "simulated-rig.md").read_text(encoding="utf-8")
    example = manual.split("```toml\n")[1].split("```")[0]
    path = tmp_path / "truth.toml"
    path.write_text(example, encoding="utf-8")
    truth = load_toml(path, TruthFile)
    assert [table.kind for table in truth.mechanism] == list(MECHANISMS)
    assert truth.model_fields_set == set(TruthFile.model_fields)
