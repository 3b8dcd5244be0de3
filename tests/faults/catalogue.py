"""The catalogue: every fault that is tried, where it acts, how often, and the outcome that is required.

Another fault is another entry. Identifiers are those of CiA 301's predefined connection set; times are machine time
since all six drives were enabled, in the middle of the capture unless stated otherwise.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Callable
from dataclasses import dataclass, replace

from tests.faults.messages import Frame, Way
from tests.faults.runs import RATE_HZ
from tests.faults.transformations import (
    FOREVER,
    Rule,
    Transformation,
    after_next,
    bits_flipped,
    break_connection,
    changed,
    drop,
    flooded,
    followed_by,
    late,
    replaced_by,
    twice,
)

AT_S = 5.3
"""Machine time at which faults act: half of the circle is captured, and slider 2 moves up at 150 mm/s."""
CYCLE_S = 1 / RATE_HZ
IN, OUT = Way.TO_CONTROLLER, Way.TO_NODES
GAUGE = 0x187


def tpdo(node: int) -> int:
    """Return the identifier of a node's answer to SYNC."""
    return 0x180 + node


SYNC, NMT, RPDO_5, EMCY_2, HEARTBEAT_2 = 0x080, 0x000, 0x205, 0x082, 0x702


@dataclass(frozen=True)
class Fault:
    """One fault.

    Attributes
    ----------
    name : str
        In the table and on the command line.
    when : str
        At which moment it acts.
    how_often : str
    cause : str
        Regular expression that the message of a run that stops must begin with.
    rules : callable
        Return the rules of the proxy; called with whether the run is in lockstep.
    rig : tuple of str
        Faults of the rig, as ``hexdbb rig --fault`` takes them.
    may_pass : bool
        Whether a run may end complete, all its samples right.
    must_pass : bool
        Whether a run must end complete: nothing is lost but the samples concerned.
    moves_machine : bool
        Whether the machine itself moves otherwise than without the fault.
    cuts_off : bool
        Whether commands no longer reach the drives, which then stop on their own.
    at_s : float
        Machine time at which it begins to act while capturing, s.
    """

    name: str
    when: str
    how_often: str
    cause: str = r"\w"
    rules: Callable[[bool], list[Rule]] = lambda lockstep: []
    rig: tuple[str, ...] = ()
    may_pass: bool = False
    must_pass: bool = False
    moves_machine: bool = False
    cuts_off: bool = False
    at_s: float = AT_S

    @property
    def begins_s(self) -> float:
        """Machine time at which it begins to act, s."""
        return self.at_s if self.when == CAPTURING else 0.0

    def at(self, at_s: float) -> Fault:
        """Return the same fault at another time of the capture, s."""
        if self.when != CAPTURING:
            return self
        rules = self.rules
        return replace(
            self,
            at_s=at_s,
            rules=lambda lockstep: [rule.fresh(at_s) for rule in rules(lockstep)],
            rig=tuple(re.sub("@[0-9.]+", f"@{at_s}", spec) for spec in self.rig),
        )


CAPTURING, BEFORE_MOTION = "while capturing", "while configuring"
ONCE, ALWAYS = "once", "from then on"


def _of(
    can_id: int, way: Way, transformation: Transformation, count: int = 1, every: int = 1, at_s: float | None = AT_S
) -> Callable[[bool], list[Rule]]:
    return lambda lockstep: [Rule(can_id, way, transformation, at_s, count, every)]


def _proxy(
    name: str,
    can_id: int,
    transformation: Transformation,
    cause: str = r"\w",
    *,
    way: Way = IN,
    count: int = 1,
    every: int = 1,
    how_often: str = "",
    **outcome: bool,
) -> Fault:
    often = how_often or {1: ONCE, FOREVER: ALWAYS}.get(count, f"{count} times")
    return Fault(name, CAPTURING, often, cause, _of(can_id, way, transformation, count, every), **outcome)


def _rig(name: str, spec: str, cause: str, *, often: str = ALWAYS, **outcome: bool) -> Fault:
    kind, _, value = spec.partition("=")
    return Fault(name, CAPTURING, often, cause, rig=(f"{kind}@{AT_S}" + (f"={value}" if value else ""),), **outcome)


def _word(clear: int = 0, set_bits: int = 0) -> Transformation:
    """Clear and set bits of the statusword in a drive's answer."""

    def change(data: bytes) -> bytes:
        (word,) = struct.unpack_from("<H", data)
        return struct.pack("<H", word & ~clear | set_bits) + data[2:]

    return changed(change)


def _position(counts: int) -> Transformation:
    """Add counts to the position in a drive's answer."""
    return changed(lambda data: data[:2] + struct.pack("<i", struct.unpack_from("<i", data, 2)[0] + counts) + data[6:])


def _target(counts: int) -> Transformation:
    """Add counts to the target in a drive's RPDO, which has the same layout."""
    return _position(counts)


def _reading(change: Callable[[float], float]) -> Transformation:
    """Change the reading in the gauge's answer."""
    return changed(lambda data: struct.pack("<f", change(struct.unpack_from("<f", data)[0])) + data[4:])


def _silent_node_in_a_flood(lockstep: bool) -> list[Rule]:
    """Send as many frames as a bus of 1 Mbit/s can carry, while a node is silent."""
    flood = flooded(Frame(0x555, bytes(8)), per_second=20_000, seconds=4.0, silent=True)
    return [Rule(tpdo(3), IN, flood, AT_S), Rule(tpdo(3), IN, drop, AT_S, FOREVER)]


def _late_for_ever(lockstep: bool) -> list[Rule]:
    delay = late(syncs=1) if lockstep else late(seconds=1.25 * CYCLE_S)
    return [Rule(GAUGE, IN, delay, AT_S, FOREVER)]


def _late_once(lockstep: bool) -> list[Rule]:
    return [Rule(GAUGE, IN, late(syncs=1), AT_S)]


FOREIGN_SYNC = followed_by(Frame(SYNC), to_nodes=True, seconds=0.3 * CYCLE_S)
EMCY_AND_NO_ERROR = followed_by(Frame(EMCY_2, bytes([0x10, 0x23, 0x01, 0, 0, 0, 0, 0])), Frame(EMCY_2, bytes(8)))

FAULTS: list[Fault] = [
    # answers
    _proxy("answer lost", tpdo(3), drop, must_pass=True),
    _proxy("answers of a node lost", tpdo(3), drop, r"node 3 ", count=FOREVER),
    _proxy(
        "every tenth answer of a node lost", tpdo(3), drop, r"node 3 ", count=FOREVER, every=10, how_often="every tenth"
    ),
    _proxy("answer twice", GAUGE, twice, r"node 7 ", may_pass=True),
    _proxy("all answers of a node twice", GAUGE, twice, r"node 7 ", count=FOREVER, may_pass=True),
    Fault("answer after the next SYNC", CAPTURING, ONCE, r"node 7 ", _late_once, may_pass=True),
    Fault("answers always 1.25 cycles late", CAPTURING, ALWAYS, r"node 7 ", _late_for_ever),
    _proxy("answers in another order", tpdo(2), after_next, must_pass=True, count=FOREVER),
    _proxy("answer too short", tpdo(4), changed(lambda data: data[:5]), r"node 4 .*(5 bytes|length)", may_pass=True),
    _proxy("answers too short", tpdo(4), changed(lambda data: data[:5]), r"node 4 .*(5 bytes|length)", count=FOREVER),
    _proxy("answers too long", GAUGE, changed(lambda data: data + bytes(3)), r"node 7 .*(bytes|length)", count=FOREVER),
    _proxy("answers empty", GAUGE, changed(lambda data: b""), r"node 7 .*(bytes|length)", count=FOREVER),
    _proxy("sign or exponent of a reading wrong", GAUGE, bits_flipped(3, 3), r"node 7 ", may_pass=True),
    _proxy("high bit of a position wrong", tpdo(2), bits_flipped(4, 5), r"node 2 ", may_pass=True),
    _proxy("bit of a statusword wrong", tpdo(2), bits_flipped(0, 1), r"node 2 ", may_pass=True),
    _proxy("reading 60 µm off", GAUGE, _reading(lambda um: um + 60.0), r"node 7 ", may_pass=True),
    _proxy("reading not a number", GAUGE, _reading(lambda um: float("nan")), r"node 7 "),
    _proxy("position jumps 2.85 mm", tpdo(2), _position(28_500), r"node 2 ", may_pass=True),
    _proxy("homing lost (bit 15)", tpdo(5), _word(clear=1 << 15), r"node 5 .*homed", count=FOREVER),
    _proxy("drive ignores targets (bit 12)", tpdo(5), _word(clear=1 << 12), r"node 5 ", count=FOREVER),
    _proxy("following error (bit 13)", tpdo(5), _word(set_bits=1 << 13), r"node 5 .*following error", count=FOREVER),
    # other services
    _proxy("EMCY of two bytes", tpdo(2), followed_by(Frame(EMCY_2, b"\x10\x23")), r"node 2 .*EMCY"),
    _proxy("EMCY, at once followed by no error", tpdo(2), EMCY_AND_NO_ERROR, r"node 2 .*EMCY 2310h"),
    _proxy("heartbeat empty", tpdo(2), followed_by(Frame(HEARTBEAT_2)), r"node 2 ", may_pass=True),
    _proxy(
        "boot-up followed by a heartbeat",
        tpdo(2),
        followed_by(Frame(HEARTBEAT_2, b"\0"), Frame(HEARTBEAT_2, b"\5")),
        r"node 2 ",
    ),
    _proxy("NMT command of one byte", tpdo(2), followed_by(Frame(NMT, b"\x02")), r"\w", may_pass=True),
    _proxy(
        "NMT stop of another master",
        tpdo(2),
        followed_by(Frame(NMT, b"\x02\x00"), to_nodes=True),
        r"\w",
        moves_machine=True,
    ),
    _proxy("SYNC of another node, once", tpdo(2), FOREIGN_SYNC, r"bus: |.*SYNC", may_pass=True, moves_machine=True),
    _proxy(
        "SYNCs of another node",
        tpdo(2),
        FOREIGN_SYNC,
        r"bus: |.*SYNC",
        count=FOREVER,
        every=3,
        how_often="every third cycle",
        moves_machine=True,
    ),
    _proxy("message that is no frame", tpdo(2), replaced_by(b"< frame 182 1.0 XYZ >"), r"\w", may_pass=True),
    _proxy("messages that are no frames", tpdo(2), replaced_by(b"< frame 182 1.0 XYZ >"), r"\w", count=FOREVER),
    _proxy("bytes that are no text", tpdo(2), replaced_by(b"< frame 182 1.0 \xff\xfe >"), r"\w", may_pass=True),
    _proxy("error frame", tpdo(2), replaced_by(b"< error 004 1.0 >"), r"\w", may_pass=True),
    _proxy(
        "flood of other frames",
        tpdo(2),
        flooded(Frame(0x555, bytes(8)), 5_000, 1.0),
        r"\w",
        may_pass=True,
        how_often="5000 a second for 1 s",
    ),
    Fault(
        "flood of other frames, a node silent",
        CAPTURING,
        "20000 a second for 4 s",
        r"node 3 |bus: flooded",
        _silent_node_in_a_flood,
    ),
    _proxy("connection broken", tpdo(2), break_connection, r"bus: ", cuts_off=True),
    # commands
    _proxy("SYNC lost", SYNC, drop, way=OUT, may_pass=True, moves_machine=True),
    _proxy("SYNC twice", SYNC, twice, way=OUT, may_pass=True, moves_machine=True),
    _proxy(
        "SYNCs lost", SYNC, drop, r"bus: no node answered", way=OUT, count=FOREVER, moves_machine=True, cuts_off=True
    ),
    _proxy("target lost", RPDO_5, drop, way=OUT, may_pass=True, moves_machine=True),
    _proxy(
        "targets of a drive lost", RPDO_5, drop, r"node 5 ", way=OUT, count=FOREVER, moves_machine=True, cuts_off=True
    ),
    _proxy("target after its SYNC", RPDO_5, late(syncs=1), way=OUT, may_pass=True, moves_machine=True),
    _proxy("target 5 mm off", RPDO_5, _target(50_000), r"node 5 ", way=OUT, moves_machine=True),
    _proxy(
        "target too short",
        RPDO_5,
        changed(lambda data: data[:4]),
        r"node 5 ",
        way=OUT,
        may_pass=True,
        moves_machine=True,
    ),
    Fault("SDO answer lost", BEFORE_MOTION, ONCE, rules=_of(0x583, IN, drop, at_s=None), must_pass=True),
    Fault("SDO answers lost", BEFORE_MOTION, ALWAYS, r"node 3 .*no answer", _of(0x583, IN, drop, FOREVER, at_s=None)),
    Fault(
        "SDO answer too short",
        BEFORE_MOTION,
        ALWAYS,
        r"node 3 ",
        _of(0x583, IN, changed(lambda data: data[:3]), FOREVER, at_s=None),
    ),
    Fault(
        "SDO answer with other object",
        BEFORE_MOTION,
        ALWAYS,
        r"node 3 ",
        _of(0x583, IN, changed(lambda data: data[:1] + b"\xff\xff" + data[3:]), FOREVER, at_s=None),
    ),
    # the rig itself
    _rig("gauge frozen", "gauge-frozen", r"node 7 .*unchanged|node 7 "),
    _rig("gauge stuck at 0.0", "gauge-stuck=0", r"node 7 "),
    _rig("reading 60 µm off from then on", "gauge-out-of-range=60", r"node 7 "),
    _rig("gauge out of range", "gauge-out-of-range", r"node 7 .*6150"),
    _rig("sensor break", "gauge-break", r"node 7 .*6150"),
    _rig("drive fault", "drive-fault:3", r"node 3 .*EMCY 2310h"),
    _rig(
        "slider jammed",
        "following-error:1",
        r"node 1 .*(following error|from its target|EMCY 8611h)",
        moves_machine=True,
    ),
    _rig("limit switch", "limit-switch:6", r"node 6 .*EMCY 8612h", moves_machine=True),
    _rig("enable lost", "enable-lost:1", r"node 1 .*switch on disabled", moves_machine=True),
    _rig("mode lost", "mode-lost:4", r"node 4 .*6061"),
    _rig("not homed any more", "not-homed:4", r"node 4 .*homed"),
    _rig("EMCY alone", "emcy:7", r"node 7 .*EMCY FF00h"),
    _rig("heartbeats lost", "heartbeat-lost:2", r"node 2 .*heartbeat", may_pass=True),
    _rig("node gone", "node-missing:5", r"node 5 .*TPDO1 missing", moves_machine=True),
    _rig("node resets itself", "boot-up:2", r"node 2 ", moves_machine=True),
    _rig("node leaves operational", "nmt-change:2", r"node 2 ", moves_machine=True),
    _rig("rig ends the connection", "bus-lost", r"bus: ", cuts_off=True),
]


def fault_named(name: str) -> Fault:
    """Return the fault of a name; raises `KeyError` for another."""
    for fault in FAULTS:
        if fault.name == name:
            return fault
    raise KeyError(name)
