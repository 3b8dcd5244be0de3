"""Generate the C11 headers of the object dictionaries from the EDS files in this folder.

Each entry becomes macros for index, sub-index, size in bytes and default, and a typedef of its C type; each PDO mapped
in the EDS becomes a packed struct in the order of the frame. Firmware that includes a header cannot deviate from the
EDS; `--check` compares the committed headers with the EDS files.

Usage: ``python firmware_interfaces/generate_header.py [--check]`` (requires canopen)
Source: CiA 301 (data types, PDO mapping 1600h and 1A00h), CiA 306 (EDS).
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TypeAlias

import canopen
from canopen.objectdictionary import ObjectDictionary, ODArray, ODRecord, ODVariable

Item: TypeAlias = "ODVariable | ODRecord | ODArray"

HERE = Path(__file__).parent
DEVICES = ("hexglider_drive", "ballbar_gauge")
C_TYPES = {
    1: ("bool", 1),
    2: ("int8_t", 1),
    3: ("int16_t", 2),
    4: ("int32_t", 4),
    5: ("uint8_t", 1),
    6: ("uint16_t", 2),
    7: ("uint32_t", 4),
    8: ("float", 4),
    0x11: ("double", 8),
    0x15: ("int64_t", 8),
    0x1B: ("uint64_t", 8),
}
"""C type and size in bytes of each CiA 301 data type; strings and domains have none."""
PDO_MAPPINGS = (("rpdo", 0x1600), ("tpdo", 0x1A00))
"""Kinds of PDO and the index of their first mapping parameter."""
PDOS_PER_KIND = 512
"""PDOs of each kind that CiA 301 provides for."""
DUMMY_USAGE = range(1, 8)
"""Indices of the dummy entries, which stand for data types."""


def main() -> int:
    """Write the headers, or compare them with --check; return the exit status, 1 if one is out of date."""
    parser = argparse.ArgumentParser(description="C headers of the object dictionaries, from the EDS files.")
    parser.add_argument("--check", action="store_true", help="write nothing; exit status 1 if a header is out of date")
    check = parser.parse_args().check
    stale = 0
    for device in DEVICES:
        path, text = HERE / f"{device}_od.h", header(device)
        if check:
            current = path.is_file() and path.read_text(encoding="ascii") == text
            stale += not current
            sys.stderr.write("" if current else f"{path.name}: out of date, run {Path(__file__).name}\n")
        else:
            path.write_text(text, encoding="ascii")
    return 1 if stale else 0


def header(device: str) -> str:
    """Return the header of one device.

    Parameters
    ----------
    device : str
        Name of the EDS without suffix.

    Returns
    -------
    str
        C11 source in ASCII.
    """
    od = canopen.import_od(str(HERE / f"{device}.eds"))
    guard = f"{device.upper()}_OD_H"
    lines = [
        f"/* {od.device_information.product_name}: object dictionary.",
        f"   Generated from {device}.eds by generate_header.py; change the EDS and run it again. */",
        f"#ifndef {guard}",
        f"#define {guard}",
        "",
        "#include <assert.h>",
        "#include <stdint.h>",
        "",
    ]
    for item in od.values():
        if item.index not in DUMMY_USAGE:
            lines += _object(device, item)
    lines += list(_pdos(device, od))
    return "\n".join([*lines, f"#endif /* {guard} */", ""])


def _object(device: str, item: Item) -> Iterator[str]:
    variables = [item] if isinstance(item, ODVariable) else list(item.values())
    yield f"/* {item.index:04X}h {item.name} */"
    for variable in variables:
        name = _name(device, item, variable)
        macro = name.upper()
        c_type, size = C_TYPES.get(variable.data_type, (None, None))
        yield f"#define {macro}_INDEX 0x{variable.index:04X}u"
        yield f"#define {macro}_SUBINDEX 0x{variable.subindex:02X}u"
        if c_type is not None:
            yield f"#define {macro}_SIZE {size}u"
            yield from _default(macro, variable)
            yield f"typedef {c_type} {name}_t;"
    yield ""


def _default(macro: str, variable: ODVariable) -> Iterator[str]:
    """Yield the macro of the default; a default that depends on the node id becomes a macro with an argument."""
    raw, value = getattr(variable, "default_raw", ""), variable.default
    if "$NODEID" in raw:
        offset = int(re.sub(r"\+?\$NODEID\+?", "", raw.upper()), 0)
        yield f"#define {macro}_DEFAULT(node_id) (0x{offset:08X}u + (node_id))"
    elif isinstance(value, float):
        yield f"#define {macro}_DEFAULT {value!r}f"
    elif value is not None:
        yield f"#define {macro}_DEFAULT {value}" + ("" if value < 0 or variable.data_type in (2, 3, 4) else "u")


def _pdos(device: str, od: ObjectDictionary) -> Iterator[str]:
    yield "/* PDOs as mapped by default; little-endian, as the frame has them. */"
    yield "#pragma pack(push, 1)"
    checks = []
    for kind, first in PDO_MAPPINGS:
        for number in range(1, PDOS_PER_KIND + 1):
            record = od.get(first + number - 1)
            if record is None or not record[0].default:
                continue
            name, size = f"{device}_{kind}{number}_t", 0
            yield "typedef struct {"
            for position in range(1, record[0].default + 1):
                mapped = record[position].default
                owner = od[mapped >> 16]
                variable = owner if isinstance(owner, ODVariable) else owner[mapped >> 8 & 0xFF]
                c_type, entry_size = C_TYPES[variable.data_type]
                size += entry_size
                yield f"    {c_type} {_identifier(variable.name)}; /* {mapped >> 16:04X}h:{mapped >> 8 & 0xFF:02X} */"
            yield f"}} {name};"
            checks.append(f'static_assert(sizeof({name}) == {size}u, "{name} must be packed");')
    yield "#pragma pack(pop)"
    yield from checks
    yield ""


def _name(device: str, item: Item, variable: ODVariable) -> str:
    parts = [device, _identifier(item.name)]
    if variable is not item:
        parts.append(_identifier(variable.name))
    return "_".join(parts)


def _identifier(text: str) -> str:
    return re.sub(r"[^a-z0-9]+", "_", text.lower()).strip("_")


if __name__ == "__main__":
    sys.exit(main())
