"""Whether a device can run the test by its EDS: vendors' files, what is missing, what it means; `hexdbb eds check`."""

from __future__ import annotations

import json
from pathlib import Path

import can
import canopen
import jsonschema
import pytest
from click.testing import CliRunner
from tests.python.capture.eds_mutations import DRIVE, GAUGE, mutated, with_key, without

from hexdbb.capture.boot import Devices, refuse_unfit
from hexdbb.capture.configuration import map_pdo
from hexdbb.capture.eds import read_eds
from hexdbb.capture.fitness import Fitness, Level, examine
from hexdbb.capture.link import Link
from hexdbb.capture.pdo import DRIVE_RPDO, DRIVE_TPDO
from hexdbb.capture.sdo import RemoteDevice
from hexdbb.capture.settings import Setting, apply, drive_settings
from hexdbb.cli import cli
from hexdbb.cli.schemas import json_schema
from hexdbb.errors import HexdbbError, InputError, RunError
from hexdbb.machine import shipped_machine

CYCLE_S = 0.004


@pytest.fixture
def fitness(tmp_path: Path):
    """Examine the device of an EDS text."""

    def of(text: str | bytes) -> Fitness:
        path = tmp_path / "device.eds"
        path.write_bytes(text if isinstance(text, bytes) else text.encode("ascii"))
        return examine(read_eds(path), shipped_machine(), CYCLE_S)

    return of


def shown(found: Fitness) -> list[tuple[str, str]]:
    return [(each.place, f"{each.level}: {each}") for each in found.findings]


@pytest.mark.parametrize(("path", "device"), [(DRIVE, "drive"), (GAUGE, "gauge")])
def test_shipped_devices_lack_nothing(path: Path, device: str, fitness) -> None:
    assert fitness(path.read_bytes()) == Fitness(device, ())


@pytest.mark.parametrize(
    ("path", "gone", "place", "consequence"),
    [
        (DRIVE, "1000", "1000:00", "its device profile is not known"),
        (DRIVE, "1400", "1400:01", "it receives no targets in time with SYNC"),
        (DRIVE, "1600", "1600:00", "it receives no targets in time with SYNC"),
        (DRIVE, "1800", "1800:01", "it does not answer in time with SYNC"),
        (DRIVE, "1A00", "1A00:00", "it does not answer in time with SYNC"),
        (DRIVE, "6040", "6040:00", "it can neither be enabled nor stopped"),
        (DRIVE, "6041", "6041:00", "its state is not known"),
        (DRIVE, "6060", "6060:00", "it cannot follow cyclic targets"),
        (DRIVE, "6061", "6061:00", "it cannot be seen whether it follows cyclic targets"),
        (DRIVE, "6064", "6064:00", "its position is not known"),
        (DRIVE, "607A", "607A:00", "it is given no targets"),
        (GAUGE, "6130", "6130:01", "there is no reading"),
        (GAUGE, "6131", "6131:01", "the unit of its readings is not known"),
        (GAUGE, "6150", "6150:01", "readings that are not valid cannot be told from others"),
    ],
)
def test_device_without_an_object_that_the_test_needs(
    path: Path, gone: str, place: str, consequence: str, fitness
) -> None:
    found = fitness(without(path, gone))
    assert not found.usable
    assert (place, f"cannot run: missing: {consequence}") in shown(found)


@pytest.mark.parametrize("place", ["6040", "6041", "6061", "6064", "607A"])
def test_object_that_no_pdo_can_hold(place: str, fitness) -> None:
    found = fitness(with_key(DRIVE, place, "PDOMapping", "0"))
    ((where, said),) = shown(found)
    assert where == f"{place}:00"
    assert said.startswith("cannot run: no PDO can hold it: PDOMapping=0 (expected 1): ")
    assert DRIVE.read_text().splitlines()[found.findings[0].line - 1] == f"[{place}]"


def test_object_that_the_test_can_do_without_is_said_with_its_consequence(fitness) -> None:
    found = fitness(without(DRIVE, "60C2", "605A"))
    assert found.usable
    assert shown(found) == [
        ("605A:00", "runs without it: missing: its quick stop follows its factory setting"),
        ("60C2:01", "runs without it: missing: it interpolates over its factory-set time"),
        ("60C2:02", "runs without it: missing: it interpolates over its factory-set time"),
    ]


@pytest.mark.parametrize(
    ("section", "key", "value", "place", "said"),
    [
        ("1000", "DefaultValue", "0x00020191", "1000:00", "device type 401 (expected a CiA 402 device)"),
        ("6502", "DefaultValue", "0x00000001", "6502:00", "modes 1h (expected bit 7"),
        ("6064", "DataType", "0x0003", "6064:00", "data type 0x0003 (expected integer of 32 bits)"),
        ("607A", "AccessType", "ro", "607A:00", "read-only (expected writable)"),
        ("1800sub2", "AccessType", "const", "", ""),
        ("607A", "DataType", "what", "607A:00", "cannot be used: DataType=what (expected a number)"),
        ("607A", "AccessType", "", "607A:00", "cannot be used: no AccessType (expected one)"),
    ],
)
def test_object_of_the_wrong_kind(section: str, key: str, value: str, place: str, said: str, fitness) -> None:
    found = fitness(with_key(DRIVE, section, key, value))
    assert [each for each, _ in shown(found)] == ([place] if place else [])
    assert all(said in text for _, text in shown(found))


def test_drive_with_one_mapping_slot(fitness) -> None:
    ((place, said),) = shown(fitness(without(DRIVE, "1600sub2")))
    expected = "cannot run: 1 of 2 mapping slots (expected room for 6040:00, 607A:00): it is given no targets"
    assert (place, said) == ("1600:02", expected)


def fixed(text_of: Path, mapping: str, last: int) -> str:
    """Make the mapping parameter of an EDS read-only."""
    head, start, rest = text_of.read_text().partition(f"[{mapping}]\n")
    body, separator, tail = rest.partition(f"[{mapping}sub{last + 1}]")
    return head + start + body.replace("AccessType=rw", "AccessType=const") + separator + tail


def test_fixed_mapping_that_is_ours_will_do_and_another_will_not(fitness) -> None:
    text = fixed(DRIVE, "1600", 2)
    assert text != DRIVE.read_text()
    assert shown(fitness(text)) == []
    ((place, said),) = shown(fitness(text.replace("DefaultValue=0x607A0020", "DefaultValue=0x60FF0020")))
    assert (place, said) == (
        "1600:02",
        "cannot run: fixed mapping 60FF0020h (expected 607A0020h): it is given no targets",
    )


def test_what_vendors_write(fitness) -> None:
    text = DRIVE.read_text()
    text = text.replace("VendorName=hexdbb\nVendorNumber=0", "VendorName=\nVendorNumber=\nÜ=Größe\n;\n[Empty]\n[]\n=\n")
    text = text.replace("ObjectType=0x7\n", "ObjectType=0x07 # VAR\n").replace(
        "AccessType=rw\n", "AccessType=RW ; always\n"
    )
    text = (
        text.replace("[607A]", "[607a]").replace("[1018sub1]", "[1018Sub1]").replace("PDOMapping=1", "pdomapping=0x1")
    )
    text = text.replace("DefaultValue=0x00020192", "DefaultValue=\nParameterValue=0x00020192")
    assert fitness(text.encode("cp1252")).findings == ()
    assert fitness(("\ufeff" + text.replace("\n", "\r\n")).encode()).findings == ()


def test_mapping_as_a_compact_array(fitness) -> None:
    text = (
        without(DRIVE, "1A00")
        + "\n[1A00]\nParameterName=map\nObjectType=8\nDataType=7\nAccessType=rw\nCompactSubObj=8\n"
    )
    found = fitness(text)
    assert shown(found) == []


def test_values_of_a_dcf_and_of_the_node(tmp_path: Path) -> None:
    path = tmp_path / "drive.dcf"
    path.write_text(
        with_key(DRIVE, "6065", "ParameterValue", "0xFFFFFFFE")
        + "\n[9000]\nDataType=4\nAccessType=rw\nDefaultValue=0xFFFFFFFF\n"
    )
    eds = read_eds(path, 5)
    assert eds.objects[0x6065, 0].value == 0xFFFFFFFE
    assert eds.objects[0x9000, 0].value == -1
    assert eds.objects[0x1400, 1].value == 0x205


@pytest.mark.parametrize(("path", "seed"), [(path, seed) for path in (DRIVE, GAUGE) for seed in range(150)])
def test_no_file_raises_anything_but_one_line(path: Path, seed: int, tmp_path: Path) -> None:
    file = tmp_path / "device.eds"
    file.write_bytes(mutated(path, seed))
    try:
        eds = read_eds(file)
        found = examine(eds, shipped_machine(), CYCLE_S)
        eds.dictionary()
    except HexdbbError as error:
        assert str(error).startswith(str(file))
        assert "\n" not in str(error)
    else:
        assert all("\n" not in str(each) for each in found.findings)


def device_on(bus: can.BusABC, path: Path) -> RemoteDevice:
    return RemoteDevice(Link(bus), 3, "slider 3", path)


def test_unfit_device_is_refused_before_anything_is_sent(tmp_path: Path) -> None:
    path = tmp_path / "drive.eds"
    path.write_text(with_key(DRIVE, "6064", "PDOMapping", "0"))
    with can.Bus(interface="virtual", channel="unfit") as bus:
        drive, gauge = device_on(bus, path), RemoteDevice(Link(bus), 7, "gauge", GAUGE)
        expected = (
            rf"^node 3 \(slider 3\): {path}:\d+: object 6064:00 no PDO can hold it: PDOMapping=0 \(expected 1\): its"
        )
        with pytest.raises(InputError, match=expected):
            refuse_unfit(Devices((drive,) * 6, gauge), shipped_machine(), CYCLE_S)


def test_text_where_a_number_is_expected_is_named(tmp_path: Path) -> None:
    path = tmp_path / "drive.eds"
    path.write_text(with_key(DRIVE, "6502", "DataType", "0x0009"))
    with can.Bus(interface="virtual", channel="text") as ours, can.Bus(interface="virtual", channel="text") as theirs:
        link, other = Link(ours), canopen.Network(theirs)
        other.NOTIFIER_CYCLE = 0.02
        other.connect()
        other.create_node(3, canopen.import_od(str(DRIVE), 3))
        with link.threaded(), pytest.raises(RunError, match=r"object 6502:00 in .*drive\.eds is of another data type"):
            RemoteDevice(link, 3, "slider 3", path).read(0x6502)
        other.notifier.stop()


def test_fixed_mapping_is_read_and_not_written(tmp_path: Path) -> None:
    path = tmp_path / "drive.eds"
    path.write_text(fixed(DRIVE, "1A00", 3))
    with can.Bus(interface="virtual", channel="fixed") as ours, can.Bus(interface="virtual", channel="fixed") as theirs:
        link, other = Link(ours), canopen.Network(theirs)
        other.NOTIFIER_CYCLE = 0.02
        other.connect()
        node = other.create_node(3, canopen.import_od(str(path), 3))
        with link.threaded():
            device = RemoteDevice(link, 3, "slider 3", path)
            assert list(map_pdo(device, DRIVE_TPDO)) == []
            assert list(map_pdo(device, DRIVE_RPDO)) == []
            node.add_read_callback(lambda index, subindex, od: 0x60FF0020 if (index, subindex) == (0x1A00, 2) else None)
            with pytest.raises(RunError, match=r"object 1A00:02 is 60FF0020h and read-only \(expected 60640020h\)"):
                list(map_pdo(device, DRIVE_TPDO))
        other.notifier.stop()


def test_read_only_setting_with_another_value_is_a_note(tmp_path: Path) -> None:
    path = tmp_path / "drive.eds"
    path.write_text(with_key(DRIVE, "605A", "AccessType", "ro"))
    (setting,) = [each for each in drive_settings(shipped_machine(), CYCLE_S) if each.index == 0x605A]
    found = examine(read_eds(path), shipped_machine(), CYCLE_S)
    assert [(each.place, each.level) for each in found.findings] == [("605A:00", Level.LIMITED)]
    with can.Bus(interface="virtual", channel="ro") as bus:
        device = device_on(bus, path)
        device.read = lambda index, subindex=0: 2
        (note,) = apply(device, [setting])
        assert note.startswith(
            "node 3 (slider 3): object 605A:00 is 2 and read-only (expected 6): its quick stop follows"
        )
        assert list(apply(device, [Setting(0x605A, 0, 2, "")])) == []


def test_command_prints_a_table_and_json(tmp_path: Path) -> None:
    bad = tmp_path / "bad.eds"
    bad.write_text(without(DRIVE, "6064"))
    done = CliRunner().invoke(cli, ["eds", "check", str(GAUGE), str(bad)])
    assert done.exit_code == 1
    assert f"{GAUGE}: gauge, can run the test: it has every object" in done.stdout
    assert f"{bad}: drive, cannot run the test" in done.stdout
    assert "6064:00" in done.stdout
    done = CliRunner().invoke(cli, ["eds", "check", str(GAUGE), str(bad), "--json"])
    jsonschema.validate(json.loads(done.stdout), json_schema("eds"), jsonschema.Draft202012Validator)
    assert [each["usable"] for each in json.loads(done.stdout)["devices"]] == [True, False]
    assert CliRunner().invoke(cli, ["eds", "check", str(DRIVE)]).exit_code == 0
