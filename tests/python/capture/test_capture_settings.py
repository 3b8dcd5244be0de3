"""Configuration against a real CANopen node: canopen's LocalNode on python-can's virtual bus."""

from __future__ import annotations

import re
import threading
from collections.abc import Iterator
from pathlib import Path

import can
import canopen
import pytest

from hexdbb.capture.boot import DRIVE_PROFILE, GAUGE_PROFILE, identify
from hexdbb.capture.configuration import map_pdo
from hexdbb.capture.link import Link
from hexdbb.capture.pdo import DRIVE_RPDO
from hexdbb.capture.sdo import RemoteDevice
from hexdbb.capture.settings import Setting, apply, drive_settings
from hexdbb.errors import InputError, RunError
from hexdbb.machine import shipped, shipped_machine

EDS = shipped("eds", "hexglider_drive.eds")
CYCLE_S = 0.004


@pytest.fixture
def drive(request: pytest.FixtureRequest) -> Iterator[tuple[RemoteDevice, canopen.LocalNode]]:
    """The controller's side and the node's side of one drive."""
    channel = request.node.name
    with can.Bus(interface="virtual", channel=channel) as ours, can.Bus(interface="virtual", channel=channel) as theirs:
        link = Link(ours)
        other = canopen.Network(theirs)
        other.NOTIFIER_CYCLE = 0.02
        other.connect()
        with EDS.open() as file:
            node = other.create_node(3, canopen.import_od(file, 3))
        with link.threaded():
            yield RemoteDevice(link, 3, "slider 3", EDS), node
        other.notifier.stop()


def test_every_setting_is_in_the_node_afterwards(drive: tuple[RemoteDevice, canopen.LocalNode]) -> None:
    device, node = drive
    settings = drive_settings(shipped_machine(), CYCLE_S)
    assert list(apply(device, settings)) == []
    for setting in settings:
        entry = node.sdo[setting.index]
        value = (entry if isinstance(entry, canopen.sdo.SdoVariable) else entry[setting.subindex]).raw
        assert value == setting.value
    assert node.sdo[0x60C2][1].raw * 10.0 ** node.sdo[0x60C2][2].raw == pytest.approx(CYCLE_S)
    assert node.sdo[0x1016][1].raw >> 16 == 127


def test_sync_has_no_period_in_lockstep() -> None:
    def period(timed: bool) -> list[int]:
        return [each.value for each in drive_settings(shipped_machine(), CYCLE_S, timed) if each.index == 0x1006]

    assert (period(True), period(False)) == ([4000], [0])


def test_a_node_that_keeps_another_value_is_refused(drive: tuple[RemoteDevice, canopen.LocalNode]) -> None:
    device, node = drive
    node.add_read_callback(lambda index, subindex, od: 1000 if index == 0x6065 else None)
    expected = r"node 3 \(slider 3\): object 6065:00 reads back 1000 \(expected 30000 as written\)"
    with pytest.raises(RunError, match=expected):
        list(apply(device, [Setting(0x6065, 0, 30000, "")]))


def test_a_node_that_aborts_is_named_with_object_value_and_reason(
    drive: tuple[RemoteDevice, canopen.LocalNode],
) -> None:
    device, _ = drive
    with pytest.raises(RunError, match=r"node 3 \(slider 3\): object 6502:00 refuses 128: .*read only"):
        device.write(0x6502, 0, 128)


def test_pdo_is_mapped_in_order_and_read_back(drive: tuple[RemoteDevice, canopen.LocalNode]) -> None:
    device, node = drive
    assert list(map_pdo(device, DRIVE_RPDO, 100)) == []
    assert [node.sdo[0x1600][k].raw for k in range(3)] == [2, 0x60400010, 0x607A0020]
    assert [node.sdo[0x1400][k].raw for k in (1, 2, 5)] == [0x203, 1, 100]


def test_device_of_another_profile_is_refused(drive: tuple[RemoteDevice, canopen.LocalNode]) -> None:
    device, node = drive
    identify(device, DRIVE_PROFILE)
    with pytest.raises(RunError, match=r"device type 402 in object 1000:00 \(expected a CiA 404 device\)"):
        identify(device, GAUGE_PROFILE)
    node.add_read_callback(lambda index, subindex, od: 99 if (index, subindex) == (0x1018, 2) else None)
    with pytest.raises(RunError, match=r"product 99 in object 1018:02 \(expected \d+, as in hexglider_drive.eds\)"):
        identify(device, DRIVE_PROFILE)


def test_silent_node_is_named(drive: tuple[RemoteDevice, canopen.LocalNode]) -> None:
    device, node = drive
    node.remove_network()
    with pytest.raises(RunError, match=r"node 3 \(slider 3\): no answer reading 6041:00"):
        device.read(0x6041)


@pytest.mark.parametrize(
    ("answer", "why"),
    [
        (b"\x43\x00\x10", r"SDO answer of 3 bytes \(43 00 10\) \(expected 8\)"),
        (b"\x43\x18\x10\x01\x92\x01\x02\x00", "returned index|returned a value for"),
        (b"\xe0\x00\x10\x00\x92\x01\x02\x00", "response|Unexpected"),
    ],
)
def test_answer_that_is_none_is_named(answer: bytes, why: str) -> None:
    name = f"answers{answer.hex()}"
    with can.Bus(interface="virtual", channel=name) as ours, can.Bus(interface="virtual", channel=name) as theirs:
        link = Link(ours)
        finished = threading.Event()

        def serve() -> None:
            while not finished.is_set():
                if theirs.recv(0.02) is not None:
                    theirs.send(can.Message(arbitration_id=0x583, data=answer, is_extended_id=False))

        thread = threading.Thread(target=serve)
        thread.start()
        try:
            with link.threaded(), pytest.raises(RunError, match=r"^node 3 \(slider 3\): .*1000:00.*") as caught:
                RemoteDevice(link, 3, "slider 3", EDS).read(0x1000)
        finally:
            finished.set()
            thread.join()
    assert re.search(why, str(caught.value))


@pytest.mark.parametrize("index", [0x1000, 0x1400, 0x1600, 0x1800, 0x1A00, 0x6131])
def test_object_missing_from_the_eds_is_named_with_node_and_file(index: int, tmp_path: Path) -> None:
    eds = tmp_path / "lean.eds"
    eds.write_text(without(f"{index:04X}"))
    with can.Bus(interface="virtual", channel=f"missing{index}") as bus:
        device = RemoteDevice(Link(bus), 3, "slider 3", eds)
        with pytest.raises(RunError, match=rf"^node 3 \(slider 3\): no object {index:04X}:01 in .*lean\.eds"):
            device.read(index, 1)


def without(index: str) -> str:
    """The drive's EDS without one object."""
    text = EDS.read_text()
    text = re.sub(rf"\[{index}(sub\w+)?\]\n(?:[^\[\n].*\n|\n)*", "", text)
    return re.sub(rf"(?m)^\d+=0x{index}\n", "", text)


@pytest.mark.parametrize(
    ("index", "meaning"), [("60C2", "interpolates over"), ("605A", "quick stop follows its factory setting")]
)
def test_missing_object_is_reported_with_its_consequence(index: str, meaning: str, tmp_path: Path) -> None:
    eds = tmp_path / "lean.eds"
    eds.write_text(without(index))
    with can.Bus(interface="virtual", channel=f"lean{index}") as bus:
        device = RemoteDevice(Link(bus), 3, "slider 3", eds)
        lacking = [setting for setting in drive_settings(shipped_machine(), CYCLE_S) if f"{setting.index:04X}" == index]
        notes = list(apply(device, lacking))
    assert notes
    for note in notes:
        assert re.match(rf"node 3 \(slider 3\): no object {index}:0\d in lean\.eds: .*{meaning}", note)


def test_drive_without_a_required_object_is_refused(tmp_path: Path) -> None:
    eds = tmp_path / "lean.eds"
    eds.write_text(without("6060"))
    with can.Bus(interface="virtual", channel="required") as bus:
        device = RemoteDevice(Link(bus), 3, "slider 3", eds)
        mode = [setting for setting in drive_settings(shipped_machine(), CYCLE_S) if setting.index == 0x6060]
        with pytest.raises(RunError, match=r"no object 6060:00 in lean\.eds: it cannot follow cyclic targets"):
            list(apply(device, mode))


@pytest.mark.parametrize(("name", "said"), [("none.eds", "cannot be read"), ("broken.eds", "not an EDS")])
def test_eds_that_is_none_is_named(name: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "broken.eds").write_text("this is no EDS\n")
    with can.Bus(interface="virtual", channel=name) as bus, pytest.raises(InputError, match=rf"{name}: {said}"):
        RemoteDevice(Link(bus), 3, "slider 3", tmp_path / name)
