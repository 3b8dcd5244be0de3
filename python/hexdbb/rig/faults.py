"""Faults to inject: a table of kinds, each a function on the rig.

Form: ``KIND[:node][@time_s][=value]``. Without a time the fault is present from power-on; with a time it occurs that
long after all six drives were first enabled, in SYNC time, so that it hits the same sample in every run.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from hexdbb.errors import InputError
from hexdbb.rig.cia402 import DriveState
from hexdbb.rig.drive import ERROR_OVERCURRENT, NEGATIVE_LIMIT, POSITIVE_LIMIT, DriveNode
from hexdbb.rig.node import NmtState

if TYPE_CHECKING:
    from hexdbb.rig.bus import Rig

SPEC = re.compile(r"(?P<kind>[a-z-]+)(:(?P<node>\d+))?(@(?P<time>[0-9.]+))?(=(?P<value>[-+0-9a-fA-Fx.]+))?")
Apply = Callable[["Rig", int, float], None]
FOREVER = 10**12
"""Cycles that no run reaches."""
WITHOUT_NODE = ("gauge", "bus")
"""Subjects of faults that are given no node."""
MILLIMETRE_UNIT = 0xFD010000
"""Unit code of mm in object 6131h (CiA 303-2): prefix 10^-3 (FDh), metre (01h)."""


@dataclass(frozen=True)
class FaultKind:
    """One row of the table.

    Attributes
    ----------
    text : str
        Description in the help.
    apply : callable
        Called with rig, node id and value.
    on : str
        Subject: ``drive`` or ``any``, which are given a node; ``gauge`` or ``bus``, which are not.
    value : float
        Value if the user gives none.
    """

    text: str
    apply: Apply
    on: str = "drive"
    value: float = 0.0


def _drive(rig: Rig, node: int) -> DriveNode:
    return next(drive for drive in rig.drives if drive.node_id == node)


def _vanish(rig: Rig, node: int, value: float) -> None:
    rig.nodes[node].present = False


def _mute_tpdo(rig: Rig, node: int, value: float) -> None:
    rig.nodes[node].muted_tpdo_cycles = int(value) or FOREVER


def _mute_heartbeat(rig: Rig, node: int, value: float) -> None:
    rig.nodes[node].muted_heartbeat = True


def _trip(rig: Rig, node: int, value: float) -> None:
    _drive(rig, node).trip(int(value))


def _emcy(rig: Rig, node: int, value: float) -> None:
    rig.nodes[node].emergency(int(value))


def _reset(rig: Rig, node: int, value: float) -> None:
    rig.nodes[node].boot()


def _leave_operational(rig: Rig, node: int, value: float) -> None:
    rig.nodes[node].change_nmt_state(NmtState.PRE_OPERATIONAL)


def _jam(rig: Rig, node: int, value: float) -> None:
    _drive(rig, node).axis.jammed = True


def _switch(rig: Rig, node: int, value: float) -> None:
    _drive(rig, node).hit_limit_switch(NEGATIVE_LIMIT if value < 0 else POSITIVE_LIMIT)


def _lose_homing(rig: Rig, node: int, value: float) -> None:
    _drive(rig, node).homed = False


def _lose_enable(rig: Rig, node: int, value: float) -> None:
    _drive(rig, node).state = DriveState.SWITCH_ON_DISABLED


def _lose_mode(rig: Rig, node: int, value: float) -> None:
    _drive(rig, node).dictionary.entry(0x6060).value = 0


def _offset(rig: Rig, node: int, value: float) -> None:
    rig.gauge.offset_um = value


def _freeze(rig: Rig, node: int, value: float) -> None:
    rig.gauge.frozen = True


def _stick(rig: Rig, node: int, value: float) -> None:
    rig.gauge.stuck_um = value


def _break(rig: Rig, node: int, value: float) -> None:
    rig.gauge.broken = True


def _lose_bus(rig: Rig, node: int, value: float) -> None:
    rig.on_bus_lost()


def _unit(rig: Rig, node: int, value: float) -> None:
    rig.gauge.dictionary.entry(0x6131, 1).value = int(value)


FAULTS: dict[str, FaultKind] = {
    "node-missing": FaultKind("the node is not on the bus", _vanish, on="any"),
    "drive-fault": FaultKind("the drive trips with this error code", _trip, value=ERROR_OVERCURRENT),
    "following-error": FaultKind("the slider jams and its drive has a following error", _jam),
    "limit-switch": FaultKind("a limit switch trips (positive; -1: negative), the drive stops", _switch, value=1),
    "enable-lost": FaultKind("the drive leaves operation enabled (safe torque off)", _lose_enable),
    "mode-lost": FaultKind("the drive leaves mode 8", _lose_mode),
    "not-homed": FaultKind("the drive is not homed", _lose_homing),
    "emcy": FaultKind("an EMCY of this code without any other effect", _emcy, on="any", value=0xFF00),
    "heartbeat-lost": FaultKind("the node sends no more heartbeats", _mute_heartbeat, on="any"),
    "tpdo-missing": FaultKind("no TPDO for this number of cycles (0: for ever)", _mute_tpdo, on="any"),
    "boot-up": FaultKind("the node resets itself", _reset, on="any"),
    "nmt-change": FaultKind("the node goes pre-operational by itself", _leave_operational, on="any"),
    "bus-lost": FaultKind("the connection to the bus breaks", _lose_bus, on="bus"),
    "gauge-out-of-range": FaultKind("the reading jumps by this value, µm", _offset, on="gauge", value=3000.0),
    "gauge-frozen": FaultKind("the reading no longer changes", _freeze, on="gauge"),
    "gauge-stuck": FaultKind("the reading is this value, µm, and no longer changes", _stick, on="gauge"),
    "gauge-break": FaultKind("sensor break: the status reports not valid", _break, on="gauge"),
    "gauge-unit": FaultKind("the gauge reads in another unit (object 6131h)", _unit, on="gauge", value=MILLIMETRE_UNIT),
}
"""All kinds of `--fault`; another kind is another entry."""


@dataclass(frozen=True)
class Injection:
    """One fault to be injected.

    Attributes
    ----------
    kind : str
        Key of `FAULTS`.
    node : int
        Node id; 0 for a fault without node.
    time_s : float or None
        SYNC time after all drives were first enabled, s; None from power-on.
    value : float
        Value of the fault.
    spec : str
        The text it was parsed from.
    """

    kind: str
    node: int
    time_s: float | None
    value: float
    spec: str

    def __str__(self) -> str:
        return self.spec

    def due(self, running_s: float | None) -> bool:
        """Return whether the fault is due `running_s` after all drives were first enabled (None: not yet)."""
        return self.time_s is None or (running_s is not None and running_s >= self.time_s - 1e-9)

    def check(self, rig: Rig) -> None:
        """Check that the rig has the node.

        Raises
        ------
        InputError
            There is no such node, or the fault does not apply to it.
        """
        if FAULTS[self.kind].on in WITHOUT_NODE:
            return
        drives = [drive.node_id for drive in rig.drives]
        known = drives if FAULTS[self.kind].on == "drive" else [*drives, rig.gauge.node_id]
        if self.node not in known:
            raise InputError(f"--fault {self.spec}: node {self.node} (expected one of {known})")

    def apply(self, rig: Rig) -> None:
        """Inject the fault."""
        FAULTS[self.kind].apply(rig, self.node, self.value)


def parse_fault(spec: str) -> Injection:
    """Parse ``KIND[:node][@time_s][=value]``.

    Raises
    ------
    InputError
        The text has another form, or the kind is unknown.
    """
    match = SPEC.fullmatch(spec)
    if match is None:
        raise InputError(f"--fault {spec}: expected KIND[:node][@time_s][=value], for example drive-fault:3@1.5=0x2310")
    kind = FAULTS.get(match["kind"])
    if kind is None:
        raise InputError(f"--fault {spec}: no fault {match['kind']} (expected one of {', '.join(FAULTS)})")
    if (match["node"] is None) != (kind.on in WITHOUT_NODE):
        wanted = f"no node, a fault of the {kind.on}" if kind.on in WITHOUT_NODE else f"a node, {match['kind']}:NODE"
        raise InputError(f"--fault {spec}: expected {wanted}")
    return Injection(
        match["kind"],
        int(match["node"] or 0),
        _number(spec, match["time"]) if match["time"] is not None else None,
        _number(spec, match["value"]) if match["value"] is not None else kind.value,
        spec,
    )


def _number(spec: str, text: str) -> float:
    try:
        return float(int(text, 16)) if text.lower().startswith("0x") else float(text)
    except ValueError:
        raise InputError(f"--fault {spec}: {text} cannot be parsed (expected a number)") from None
