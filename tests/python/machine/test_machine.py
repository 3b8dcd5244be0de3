from __future__ import annotations

from pathlib import Path

import pytest

from hexdbb.errors import InputError
from hexdbb.machine import CanSetup, load_machine, machine_beside, shipped, shipped_machine

TEXT = shipped("sp120.toml").read_text(encoding="utf-8")


def error_of(tmp_path: Path, old: str, new: str) -> str:
    assert old in TEXT
    path = tmp_path / "machine.toml"
    path.write_text(TEXT.replace(old, new), encoding="utf-8")
    with pytest.raises(InputError) as caught:
        load_machine(path)
    message = str(caught.value)
    assert "\n" not in message
    return message.removeprefix(f"{tmp_path}/")


def test_shipped_machine_has_the_assumed_dimensions_and_says_so() -> None:
    machine = shipped_machine()
    assert (machine.base.inradius_mm, machine.platform.circumradius_mm, machine.legs.length_mm) == (250.0, 120.0, 400.0)
    assert (machine.platform.joint_plane_height_mm, machine.platform.moved_mass_kg) == (20.0, 12.0)
    sliders = machine.sliders
    assert (sliders.travel_mm, sliders.min_gap_mm, sliders.screw_lead_mm) == ((20.0, 846.0), 60.0, 5.0)
    assert "assumed" in machine.name
    assert "ASSUMED" in TEXT.splitlines()[0]


def test_can_section_is_optional_and_the_shipped_one_holds_the_defaults(tmp_path: Path) -> None:
    path = tmp_path / "machine.toml"
    path.write_text(TEXT[: TEXT.index("[can]")], encoding="utf-8")
    machine = load_machine(path)
    assert machine.can is None
    assert machine.can_setup == CanSetup() == shipped_machine().can


def test_one_eds_name_stands_for_all_drives_and_six_for_each(tmp_path: Path) -> None:
    assert shipped_machine().can_setup.drive_eds == ("hexglider_drive.eds",) * 6
    path = tmp_path / "machine.toml"
    names = ["a.eds", "b.eds", "c.eds", "d.eds", "e.eds", "f.eds"]
    path.write_text(TEXT.replace('drive_eds = "hexglider_drive.eds"', f"drive_eds = {names}"), encoding="utf-8")
    assert load_machine(path).can_setup.drive_eds == tuple(names)


def test_shipped_eds_files_are_there() -> None:
    can = shipped_machine().can_setup
    assert all(shipped("eds", name).is_file() for name in (*can.drive_eds, can.gauge_eds))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("inradius_mm", "inradius_m", "machine.toml: base.inradius_m: unknown key (expected inradius_mm: the unit"),
        ("inradius_mm = 250.0", "inradius_mm = 0.25", "machine.toml: sliders.travel_mm: [20.0, 846.0] (expected some"),
        ("inradius_mm = 250.0", "inradius_mm = -250", "machine.toml: base.inradius_mm: -250 (expected a number > 0)"),
        ("length_mm = 400.0", "length_mm = 130", "machine.toml: legs.length_mm: 130 (expected more than 130, the dis"),
        ("[20.0, 846.0]", "[846.0, 20.0]", "machine.toml: sliders.travel_mm: [846.0, 20.0] (expected the least coord"),
        ("[20.0, 846.0]", "[20.0, 420.0]", "machine.toml: sliders.travel_mm: [20.0, 420.0] (expected some of 433.0"),
        ("min_gap_mm = 60.0", "min_gap_mm = 0", "machine.toml: sliders.min_gap_mm: 0 (expected a number > 0)"),
        ("min_gap_mm = 60.0", "min_gap_mm = 900", "machine.toml: sliders.min_gap_mm: 900 (expected less than the"),
        ("moved_mass_kg = 12.0", "moved_mass_kg = 0", "machine.toml: platform.moved_mass_kg: 0 (expected a number >"),
        ('name = "SP-120 (assumed dimensions)"', 'name = ""', 'machine.toml: name: "" (expected a text that is not'),
        ("[1, 2, 3, 4, 5, 6]", "[1, 2, 3, 2, 5, 6]", "machine.toml: can.drive_nodes[3]: 2 (expected a node id not"),
        (
            "[1, 2, 3, 4, 5, 6]",
            "[1, 2, 3, 4, 5, 200]",
            "machine.toml: can.drive_nodes[5]: 200 (expected a number <= 127",
        ),
        ("[1, 2, 3, 4, 5, 6]", "[1, 2, 3]", "machine.toml: can.drive_nodes[3]: missing (expected a value)"),
        (
            "gauge_node = 7",
            "gauge_node = 6",
            "machine.toml: can.gauge_node: 6 (expected a node id not used by a drive)",
        ),
        ("bitrate_bit_s = 1000000", "bitrate_bit_s = 9600", "machine.toml: can.bitrate_bit_s: 9600 (expected 10000,"),
        ("counts_per_mm = 10000.0", "counts_per_mm = 0", "machine.toml: can.counts_per_mm: 0 (expected a number other"),
        ("consumer_ms = 300", "consumer_ms = 100", "machine.toml: can.heartbeat_consumer_ms: 100 (expected more than"),
        ("jerk_mm_s3", "jerk_m_s3", "machine.toml: can.limits.jerk_m_s3: unknown key (expected jerk_mm_s3"),
        ("cycle_rate_hz = 250.0", "cycle_rate_hz = 5000", "machine.toml: can.cycle_rate_hz: 5000 (expected a number <"),
        ("hexdbb.machine/1", "hexdbb.plan/1", 'machine.toml: schema: "hexdbb.plan/1" (expected "hexdbb.machine/1")'),
    ],
)
def test_bad_machine_is_refused_with_key_and_value(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert error_of(tmp_path, old, new).startswith(message)


def test_machine_is_found_beside_the_file_that_names_it(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "mine.toml").write_text(TEXT.replace("12.0", "13.0"), encoding="utf-8")
    naming = tmp_path / "plan.toml"
    assert machine_beside("sub/mine.toml", naming).platform.moved_mass_kg == 13.0
    assert machine_beside("sp120", naming) == shipped_machine()
    with pytest.raises(InputError, match=r'plan.toml: machine: "other.toml": no such file .*"sp120"'):
        machine_beside("other.toml", naming)


def test_a_machine_shows_its_dimensions() -> None:
    machine = shipped_machine()
    assert repr(machine) == (
        "<MachineFile SP-120 (assumed dimensions): base inradius 250 mm, platform circumradius 120 mm, legs 400 mm,"
        " travel 20 to 846 mm>"
    )
    assert "<td>sliders.min_gap_mm</td><td>60.0</td>" in machine._repr_html_()
