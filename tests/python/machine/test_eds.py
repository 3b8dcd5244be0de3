"""The EDS files: what two readers with different ideas make of them, the layout both sides rely on, the C headers."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import canopen
import pytest
from canopen.objectdictionary import ODVariable

from hexdbb.machine import shipped

ROOT = Path(__file__).parents[3]
FOLDER = ROOT / "firmware_interfaces"
DEVICES = ("hexglider_drive", "ballbar_gauge")

DRIVE_OBJECTS = (
    "1000 1001 1003 1005 1006 1007 1008 1014 1016 1017 1018 1029 1400 1600 1800 1A00 6007 603F 6040 6041 605A 605B "
    "605C 605D 605E 6060 6061 6064 6065 6066 606C 607A 607D 60C2 60F4 6502"
)
GAUGE_OBJECTS = "1000 1001 1005 1006 1008 1014 1017 1018 1800 1A00 2100 6110 6126 6127 6130 6131 6132 6150 9130"


def variables(od: canopen.ObjectDictionary) -> list[ODVariable]:
    return [v for item in od.values() for v in ([item] if isinstance(item, ODVariable) else item.values())]


@pytest.mark.parametrize("device", DEVICES)
def test_dcfchk_accepts_it_without_a_word(device):
    checked = subprocess.run(
        [
            sys.executable,
            "-W",
            "error",
            "-c",
            "from dcf.cli import main; main()",
            "-n",
            "3",
            str(FOLDER / f"{device}.eds"),
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (checked.returncode, checked.stdout, checked.stderr) == (0, "", "")


@pytest.mark.parametrize("device", DEVICES)
def test_canopen_reads_every_default_the_file_states(device):
    path = FOLDER / f"{device}.eds"
    od = canopen.import_od(str(path), 3)
    stated = path.read_text(encoding="ascii").count("DefaultValue=")
    assert sum(v.default is not None for v in variables(od) if v.index >= 0x1000) == stated
    assert all(v.access_type in ("ro", "rw", "rww", "rwr", "wo", "const") for v in variables(od))


@pytest.mark.parametrize(("device", "objects"), [("hexglider_drive", DRIVE_OBJECTS), ("ballbar_gauge", GAUGE_OBJECTS)])
def test_objects_of_the_interface_are_there(device, objects):
    od = canopen.import_od(str(FOLDER / f"{device}.eds"), 3)
    assert [index for index in objects.split() if int(index, 16) not in od] == []


@pytest.mark.parametrize(
    ("device", "mapping", "communication", "cob_id", "entries"),
    [
        ("hexglider_drive", 0x1600, 0x1400, 0x203, [0x60400010, 0x607A0020]),
        ("hexglider_drive", 0x1A00, 0x1800, 0x40000183, [0x60410010, 0x60640020, 0x60610008]),
        ("ballbar_gauge", 0x1A00, 0x1800, 0x40000183, [0x61300120, 0x61500108]),
    ],
)
def test_default_pdos_are_the_agreed_layout(device, mapping, communication, cob_id, entries):
    od = canopen.import_od(str(FOLDER / f"{device}.eds"), 3)
    assert od[communication][1].default == cob_id
    assert od[communication][2].default == 1
    assert [od[mapping][k].default for k in range(1, od[mapping][0].default + 1)] == entries
    for entry in entries:
        item = od[entry >> 16]
        variable = item if isinstance(item, ODVariable) else item[entry >> 8 & 0xFF]
        assert variable.pdo_mappable
        assert len(variable) == entry & 0xFF


def test_unit_reads_as_micrometre():
    od = canopen.import_od(str(FOLDER / "ballbar_gauge.eds"), 7)
    unit = od[0x6131][1].default
    assert (unit >> 24, unit >> 16 & 0xFF) == (-6 & 0xFF, 0x01)


@pytest.mark.parametrize("device", DEVICES)
def test_package_carries_the_same_file(device):
    assert shipped("eds", f"{device}.eds").read_bytes() == (FOLDER / f"{device}.eds").read_bytes()


def test_headers_are_what_the_eds_files_give():
    script = FOLDER / "generate_header.py"
    checked = subprocess.run(
        [sys.executable, str(script), "--check"], capture_output=True, text=True, check=False, timeout=60
    )
    assert (checked.returncode, checked.stderr) == (0, "")


def test_check_notices_an_eds_that_changed(tmp_path):
    for name in ("generate_header.py", *(f"{d}.eds" for d in DEVICES), *(f"{d}_od.h" for d in DEVICES)):
        shutil.copy(FOLDER / name, tmp_path / name)
    eds = tmp_path / "ballbar_gauge.eds"
    eds.write_text(eds.read_text(encoding="ascii").replace("Set-up number", "Mount number"), encoding="ascii")
    checked = subprocess.run(
        [sys.executable, str(tmp_path / "generate_header.py"), "--check"], capture_output=True, text=True, check=False
    )
    assert checked.returncode == 1
    assert "ballbar_gauge_od.h: out of date" in checked.stderr
    assert "hexglider_drive_od.h" not in checked.stderr


def test_headers_compile_as_c11_and_hold_the_layout(tmp_path):
    compiler = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    assert compiler is not None, "building hexdbb needs a C compiler"
    source = tmp_path / "layout.c"
    source.write_text(
        """
#include <stddef.h>
#include <stdio.h>
#include "ballbar_gauge_od.h"
#include "hexglider_drive_od.h"
int main(void) {
    printf("%zu %zu ", sizeof(hexglider_drive_rpdo1_t), offsetof(hexglider_drive_rpdo1_t, target_position));
    printf("%zu %zu ", sizeof(hexglider_drive_tpdo1_t), sizeof(ballbar_gauge_tpdo1_t));
    printf("%x ", HEXGLIDER_DRIVE_CONTROLWORD_INDEX);
    printf("%x ", HEXGLIDER_DRIVE_RPDO_COMMUNICATION_PARAMETER_1_COB_ID_USED_BY_RPDO_DEFAULT(3u));
    printf("%u %x", HEXGLIDER_DRIVE_POSITION_ACTUAL_VALUE_SIZE, BALLBAR_GAUGE_AI_INPUT_PV_AI_INPUT_PV_1_INDEX);
    return 0;
}
""",
        encoding="ascii",
    )
    program = tmp_path / "layout"
    flags = ["-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror", f"-I{FOLDER}"]
    subprocess.run([compiler, *flags, str(source), "-o", str(program)], check=True)
    printed = subprocess.run([str(program)], capture_output=True, text=True, check=True).stdout
    assert printed == "6 2 7 5 6040 203 4 6130"
