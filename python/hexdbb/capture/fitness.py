"""Whether a device can run the circular test, judged by its EDS alone: what it lacks, and what that means.

The objects are those of the bus configuration (`settings`, `pdo`), with the consequences stated there: a table of
findings here, a refusal before motion in `boot`.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import Literal

from hexdbb.capture.cia402 import CYCLIC_SYNCHRONOUS_POSITION
from hexdbb.capture.eds import Eds
from hexdbb.capture.pdo import DRIVE_RPDO, DRIVE_TPDO, GAUGE_TPDO, READING, SYNCHRONOUS, Mapped, PdoLayout
from hexdbb.capture.sdo import name
from hexdbb.capture.settings import GAUGE_UNIT, Setting, communication_settings, drive_settings, rpdo_deadline
from hexdbb.machine import MachineFile

DRIVE_PROFILE, GAUGE_PROFILE = 402, 404
"""Device profile numbers in the low word of object 1000h."""


class Level(StrEnum):
    """Weight of a finding."""

    REFUSED = "cannot run"
    LIMITED = "runs without it"
    TO_SET = "to be set in the device"


@dataclass(frozen=True)
class Finding:
    """One object that is not as the test needs it.

    Attributes
    ----------
    level : Level
        Whether the device can run the test all the same.
    place : str
        The object: ``6040:00``.
    what : str
        What is wrong, and what was expected.
    consequence : str
        What that means for the test.
    line : int or None
        Line of the EDS that says so; None if none does.
    """

    level: Level
    place: str
    what: str
    consequence: str
    line: int | None = None

    def __str__(self) -> str:
        return f"{self.what}: {self.consequence}"


@dataclass(frozen=True)
class Fitness:
    """Whether a device can run the test.

    Attributes
    ----------
    device : str
        What it was examined as: ``drive`` or ``gauge``.
    findings : tuple of Finding
        What it lacks; what refuses it first.
    """

    device: Literal["drive", "gauge"]
    findings: tuple[Finding, ...]

    @property
    def usable(self) -> bool:
        """Whether nothing refuses it."""
        return all(each.level is not Level.REFUSED for each in self.findings)


def examine(eds: Eds, machine: MachineFile, cycle_s: float, device: Literal["drive", "gauge"] | None = None) -> Fitness:
    """Return whether a device can run the test.

    Parameters
    ----------
    eds : Eds
        Its EDS.
    machine : MachineFile
        Values of the settings.
    cycle_s : float
        SYNC period, s.
    device : str, optional
        What it is to be; by default what its device type says, or failing that its objects.
    """
    if device is None:
        described = eds.get(0x1000, 0)
        stated = described.value if described is not None and isinstance(described.value, int) else 0
        known = {DRIVE_PROFILE: True, GAUGE_PROFILE: False}.get(stated & 0xFFFF)
        is_drive = eds.get(READING.index, READING.subindex) is None if known is None else known
        device = "drive" if is_drive else "gauge"
    profile = DRIVE_PROFILE if device == "drive" else GAUGE_PROFILE
    return Fitness(device, tuple(findings(eds, profile, machine, cycle_s)))


def findings(eds: Eds, profile: int, machine: MachineFile, cycle_s: float) -> list[Finding]:
    """Return what a device lacks for the test.

    Parameters
    ----------
    eds : Eds
        Its EDS.
    profile : int
        What it is to be: `DRIVE_PROFILE` or `GAUGE_PROFILE`.
    machine : MachineFile
        Values of the settings.
    cycle_s : float
        SYNC period, s.

    Returns
    -------
    list of Finding
        What refuses it first.
    """
    found = [*_device_type(eds, profile)]
    if profile == DRIVE_PROFILE:
        found += _mode(eds)
        for layout in (DRIVE_RPDO, DRIVE_TPDO):
            found += _pdo(eds, layout)
        deadline = rpdo_deadline(machine.can_setup.rpdo_timeout_ms)
        found += _settings(eds, [*drive_settings(machine, cycle_s), deadline])
    else:
        found += [*_unit(eds), *_pdo(eds, GAUGE_TPDO)]
        found += _settings(eds, communication_settings(machine, cycle_s))
    return sorted(found, key=lambda finding: list(Level).index(finding.level))


def _device_type(eds: Eds, profile: int) -> Iterator[Finding]:
    described = eds.get(0x1000, 0)
    without = "its device profile is not known"
    if described is None:
        yield _missing(eds, 0x1000, 0, Level.REFUSED, without)
    elif isinstance(described.value, int) and described.value & 0xFFFF != profile:
        what = f"device type {described.value & 0xFFFF} (expected a CiA {profile} device)"
        yield Finding(Level.REFUSED, name(0x1000, 0), what, "its objects mean something else", described.line)


def _mode(eds: Eds) -> Iterator[Finding]:
    described = eds.get(0x6502, 0)
    bit = 1 << (CYCLIC_SYNCHRONOUS_POSITION - 1)
    if described is not None and isinstance(described.value, int) and described.value and not described.value & bit:
        what = f"modes {described.value:X}h (expected bit 7, cyclic synchronous position)"
        yield Finding(Level.REFUSED, name(0x6502, 0), what, "it cannot follow cyclic targets", described.line)


def _unit(eds: Eds) -> Iterator[Finding]:
    index, subindex = GAUGE_UNIT.index, GAUGE_UNIT.subindex
    described = eds.get(index, subindex)
    if described is None:
        yield _missing(eds, index, subindex, Level.REFUSED, GAUGE_UNIT.without)
    elif isinstance(described.value, int) and described.value & 0xFFFFFFFF != GAUGE_UNIT.value:
        what = f"unit {described.value & 0xFFFFFFFF:08X}h (expected {GAUGE_UNIT.value:08X}h, {GAUGE_UNIT.meaning})"
        level = Level.REFUSED if described.access == "const" else Level.TO_SET
        yield Finding(level, name(index, subindex), what, "its readings have another unit", described.line)


def _settings(eds: Eds, settings: Iterable[Setting]) -> Iterator[Finding]:
    for setting in settings:
        described = eds.get(setting.index, setting.subindex)
        level = Level.REFUSED if setting.required else Level.LIMITED
        if described is None:
            yield _missing(eds, setting.index, setting.subindex, level, setting.without)
        elif not described.writable and described.value != setting.value:
            value = "" if described.value is None else f" with value {described.value}"
            what = f"read-only{value} (expected {setting.value})"
            place = name(setting.index, setting.subindex)
            yield Finding(level, place, what, setting.without, described.line)


def _pdo(eds: Eds, layout: PdoLayout) -> Iterator[Finding]:
    places = [(layout.communication, 1), (layout.communication, 2)]
    places += [(layout.mapping, subindex) for subindex in layout.entries]
    lacking = [_missing(eds, *place, Level.REFUSED, layout.without) for place in places if eds.get(*place) is None]
    slots = sum(eds.get(layout.mapping, k) is not None for k in layout.entries if k)
    if lacking and 0 < slots < len(layout.objects):
        wanted = ", ".join(name(each.index, each.subindex) for each in layout.objects)
        what = f"{slots} of {len(layout.objects)} mapping slots (expected room for {wanted})"
        yield Finding(Level.REFUSED, name(layout.mapping, slots + 1), what, layout.objects[slots].without)
    elif lacking:
        yield from lacking
    else:
        yield from _transmission(eds, layout)
        parameters = [eds.get(layout.mapping, subindex) for subindex in layout.entries]
        fixed = any(each is not None and not each.writable for each in parameters)
        if fixed:
            yield from _fixed_mapping(eds, layout)
        for mapped in layout.objects:
            yield from _mapped(eds, mapped, received=layout is DRIVE_RPDO, is_mapped=fixed)


def _transmission(eds: Eds, layout: PdoLayout) -> Iterator[Finding]:
    described = eds.get(layout.communication, 2)
    if described is not None and not described.writable and described.value not in (None, SYNCHRONOUS):
        what = f"read-only with value {described.value} (expected {SYNCHRONOUS}, with every SYNC)"
        yield Finding(Level.REFUSED, name(layout.communication, 2), what, layout.without, described.line)


def _fixed_mapping(eds: Eds, layout: PdoLayout) -> Iterator[Finding]:
    """Yield where a mapping that cannot be written differs from ours; values not stated are read at the start."""
    for subindex, wanted in layout.entries.items():
        described = eds.get(layout.mapping, subindex)
        if described is not None and isinstance(described.value, int) and described.value != wanted:
            what = f"fixed mapping {described.value:X}h (expected {wanted:X}h)"
            consequence = layout.without if subindex == 0 else layout.objects[subindex - 1].without
            yield Finding(Level.REFUSED, name(layout.mapping, subindex), what, consequence, described.line)


def _mapped(eds: Eds, mapped: Mapped, received: bool, is_mapped: bool) -> Iterator[Finding]:
    """Yield what keeps an object out of its PDO; what a device maps by itself (`is_mapped`) is mappable."""
    described = eds.get(mapped.index, mapped.subindex)
    place, bits, real = name(mapped.index, mapped.subindex), 8 * struct.calcsize(mapped.code), mapped.code == "f"
    if described is None:
        yield _missing(eds, mapped.index, mapped.subindex, Level.REFUSED, mapped.without)
    elif described.bits != bits or described.real != real:
        kind = "REAL" if real else "integer of"
        what = f"data type {described.data_type:#06x} (expected {kind} {bits} bits)"
        yield Finding(Level.REFUSED, place, what, mapped.without, described.line)
    elif not (described.mappable or is_mapped):
        what = "no PDO can hold it: PDOMapping=0 (expected 1)"
        yield Finding(Level.REFUSED, place, what, mapped.without, described.line)
    elif received and not described.writable:
        yield Finding(Level.REFUSED, place, "read-only (expected writable)", mapped.without, described.line)


def _missing(eds: Eds, index: int, subindex: int, level: Level, without: str) -> Finding:
    wrong = eds.unusable.get((index, subindex))
    if wrong is None:
        return Finding(level, name(index, subindex), "missing", without)
    return Finding(level, name(index, subindex), f"cannot be used: {wrong.what}", without, wrong.line)
