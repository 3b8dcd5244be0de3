"""The rig with EDS files that are none: one line that names the file, never a traceback."""

from __future__ import annotations

import logging
from pathlib import Path

import pytest
from tests.python.capture.eds_mutations import DRIVE, GAUGE, mutated, with_key, without

from hexdbb.errors import InputError
from hexdbb.machine import MachineFile, load_machine, shipped
from hexdbb.rig.bus import Rig
from hexdbb.rig.truth import TruthFile, random_truth

MACHINE, TRUTH = "machine.toml", random_truth(1)


@pytest.fixture
def machine(tmp_path: Path) -> MachineFile:
    logging.getLogger("canopen").setLevel(logging.CRITICAL)
    for name, source in ((MACHINE, shipped("sp120.toml")), (DRIVE.name, DRIVE), (GAUGE.name, GAUGE)):
        (tmp_path / name).write_bytes(source.read_bytes())
    return load_machine(tmp_path / MACHINE)


def used(machine: MachineFile, truth: TruthFile) -> None:
    """Build a rig and let its nodes answer."""
    rig = Rig(machine, truth)
    rig.receive(0x000, b"\x01\x00")
    for _ in range(2):
        rig.receive(0x201, bytes(6))
        rig.receive(0x080, b"")
    for node in rig.nodes.values():
        for index in (0x1000, 0x1008, 0x6041, 0x6064, 0x6130):
            node.handle_sdo(b"\x40" + index.to_bytes(2, "little") + bytes(5))


@pytest.mark.parametrize("seed", range(40))
@pytest.mark.parametrize("device", [DRIVE, GAUGE])
def test_changed_file_is_one_line_or_works(device: Path, seed: int, machine: MachineFile, tmp_path: Path) -> None:
    (tmp_path / device.name).write_bytes(mutated(device, seed))
    try:
        used(machine, TRUTH)
    except InputError as error:
        assert str(error).startswith(str(tmp_path / device.name))
        assert "\n" not in str(error)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", r"object 1000h:00 is missing"),
        ("[1000]\nParameterName=x\n", r"not an EDS: No option"),
        ("no ini file", r"not an EDS: File contains no section headers"),
        (without(DRIVE, "6064"), r"object 6064h:00 is missing"),
        (with_key(DRIVE, "6064", "DataType", "0x0003"), r"object 6064h:00 has another data type"),
        (with_key(DRIVE, "1600sub1", "DefaultValue", "0x12340010"), r"default mapping in 1600h cannot be used"),
        (with_key(DRIVE, "6065", "DefaultValue", "0xFFFFFFFFFF"), r"object 6065h:00: DefaultValue=0xFFFFFFFFFF"),
        (with_key(DRIVE, "6065", "DataType", "0x0009"), r"object 6065h:00.* is no number|DefaultValue"),
    ],
)
def test_message_names_the_object(text: str, said: str, machine: MachineFile, tmp_path: Path) -> None:
    (tmp_path / DRIVE.name).write_text(text)
    with pytest.raises(InputError, match=said):
        used(machine, TRUTH)
