"""Machine files whose guideways, legs and travels are not alike: what is read, what is refused, and the home."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from hexdbb.errors import InputError
from hexdbb.files.validation import dump_toml, parse_toml
from hexdbb.kinematics import inverse
from hexdbb.machine import MachineFile, home_heights_mm, load_machine, shipped, shipped_machine

UNLIKE = Path(__file__).parents[2] / "data" / "machines" / "unlike.toml"
SHIPPED = shipped("sp120.toml").read_text(encoding="utf-8")
ANGLES = "inradius_mm = 250.0\nguideway_angles_deg = "


def parsed(old: str, new: str) -> MachineFile:
    assert old in SHIPPED
    return parse_toml(SHIPPED.replace(old, new, 1), MachineFile, "machine.toml")


def test_one_value_serves_all_six() -> None:
    machine = shipped_machine()
    assert machine.legs.lengths_mm == (400.0,) * 6
    assert machine.sliders.travels_mm == ((20.0, 846.0),) * 6
    assert machine.base.guideway_angles_rad == pytest.approx(np.radians([0.0, 120.0, 240.0]))


def test_equal_values_are_the_same_machine_as_one() -> None:
    assert parsed("length_mm = 400.0", "length_mm = [400, 400, 400.0, 400, 400, 400]") == shipped_machine()
    assert parsed("[20.0, 846.0]", str([[20.0, 846.0]] * 6)) == shipped_machine()


def test_unlike_values_are_read_and_written() -> None:
    machine = load_machine(UNLIKE)
    assert machine.legs.lengths_mm == (398.0, 403.0, 407.0, 391.0, 400.0, 412.0)
    assert machine.sliders.guideway_travels_mm == ((40.0, 860.0), (25.0, 880.0), (30.0, 870.0))
    assert parse_toml(dump_toml(machine), MachineFile, "again") == machine
    assert "legs 398, 403, 407, 391, 400, 412 mm" in repr(machine)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("length_mm = 400.0", "length_mm = [400, 400, 400, 400, 400]", "legs.length_mm[5]: missing (expected a value)"),
        (
            "length_mm = 400.0",
            "length_mm = [400, 400, -1, 400, 400, 3]",
            "legs.length_mm[2]: -1 (expected a number > 0)",
        ),
        ("length_mm = 400.0", "length_mm = nan", "legs.length_mm: nan (expected a finite number)"),
        (
            "length_mm = 400.0",
            "length_mm = [400, 400, 120, 400, 400, 400]",
            "legs.length_mm[2]: 120 (expected more than 130, the distance between guideway and joint circle",
        ),
        ("[20.0, 846.0]", "[nan, 846.0]", "sliders.travel_mm[0]: nan (expected a finite number)"),
        ("[20.0, 846.0]", "[]", "sliders.travel_mm[0]: missing (expected a value)"),
        (
            "[20.0, 846.0]",
            "[[20, 446], [400, 846], [20, 1], [400, 846], [20, 446], [400, 846]]",
            "sliders.travel_mm[2]: [20.0, 1.0] (expected the least coordinate before the largest)",
        ),
        (
            "[20.0, 846.0]",
            "[[20, 446], [400, 846], [20, 446], [400, 846], [1, 44], [400, 846]]",
            "sliders.travel_mm[4]: [1.0, 44.0] (expected some of 54.7 to 433.0, where slider 5 stands with",
        ),
        (
            "[20.0, 846.0]",
            "[[20, 446], [400, 846], [20, 446], [400, 846], [1, 80], [400, 500]]",
            "(expected travels that leave a height at which the platform stands centred and level with gaps of 60",
        ),
        (
            "inradius_mm = 250.0",
            ANGLES + "[0, 2.09, 4.19]",
            "base.guideway_angles_deg[1]: 2.09 (expected 30 or more beyond 0: counter-clockwise, once around)",
        ),
        (
            "inradius_mm = 250.0",
            ANGLES + "[0, 120, 350]",
            "base.guideway_angles_deg[2]: 350 (expected 30 or more before",
        ),
        (
            "inradius_mm = 250.0",
            ANGLES + "[0, 240, 120]",
            "base.guideway_angles_deg[2]: 120 (expected 30 or more beyond",
        ),
        (
            "[sliders]",
            "[joints]\nswing_deg = [40.0, -10.0]\n[sliders]",
            "joints.swing_deg: [40.0, -10.0] (expected the least angle before the largest)",
        ),
        (
            "[sliders]",
            "[workspace]\ncentre_mm = [0, 0, 280]\nradius_mm = -1\n[sliders]",
            "workspace.radius_mm: -1 (expected a number > 0)",
        ),
    ],
)
def test_what_cannot_be_is_named(old: str, new: str, message: str) -> None:
    with pytest.raises(InputError) as error:
        parsed(old, new)
    assert str(error.value).startswith("machine.toml: ")
    assert message in str(error.value)


@pytest.mark.parametrize("path", [shipped("sp120.toml"), UNLIKE])
def test_the_home_is_where_inverse_kinematics_says(path: Path) -> None:
    machine = load_machine(path)
    low, high = home_heights_mm(machine)
    height = np.array([low + 0.01, 0.5 * (low + high), high - 0.01, high + 0.01, *([low - 0.01] if low else [])])
    position = np.column_stack([np.zeros((len(height), 2)), height - machine.platform.joint_plane_height_mm])
    _, status = inverse(machine, position, np.zeros(3))
    assert (status == 0).tolist() == [True, True, True, *([False] * (len(height) - 3))]
