"""A CANopen node: NMT state machine, boot-up, heartbeats, SDO server, synchronous PDOs, EMCY.

Model: frames arrive through the methods `handle_...` and leave through the bus callback; a SYNC is `sample`, then
`apply`. Process data run in SYNC time; heartbeats and RPDO deadlines run in wall-clock time, as on a real bus.
Assumption: predefined connection set, 11-bit identifiers, one SDO server.
Source: CiA 301 (NMT, heartbeat 1016h and 1017h, SDO, PDO, EMCY 1001h and 1003h, error behaviour 1029h).
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from enum import IntEnum
from pathlib import Path
from typing import ClassVar

from canopen.sdo import SdoAbortedError, SdoServer

from hexdbb.errors import InputError
from hexdbb.rig.dictionary import DEVICE_NAME, Dictionary, Key
from hexdbb.rig.frame import EMCY_BASE, HEARTBEAT_BASE, SDO_REQUEST_BASE, SDO_RESPONSE_BASE
from hexdbb.rig.pdo import MAX_SYNC_TYPE, Pdo
from hexdbb.rig.sync_counter import SyncCounter

log = logging.getLogger(__name__)

Send = Callable[[int, bytes], None]
"""Puts a frame (identifier, data) on the bus."""

ERROR_HEARTBEAT, ERROR_RPDO_TIMEOUT, ERROR_PDO_LENGTH = 0x8130, 0x8250, 0x8210
"""EMCY error codes."""
GENERIC, CURRENT, COMMUNICATION, PROFILE = 0x01, 0x02, 0x10, 0x20
"""Bits of the error register 1001h."""


class NmtState(IntEnum):
    """NMT states as heartbeats carry them."""

    BOOT_UP = 0x00
    STOPPED = 0x04
    OPERATIONAL = 0x05
    PRE_OPERATIONAL = 0x7F


NMT_COMMANDS = {0x01: NmtState.OPERATIONAL, 0x02: NmtState.STOPPED, 0x80: NmtState.PRE_OPERATIONAL}
"""NMT command specifiers and the states they lead to."""
NMT_RESETS = (0x81, 0x82)
"""Reset node, reset communication."""
_OPERATIONAL = NmtState.OPERATIONAL
"""Looked up for every frame: a member of an enumeration costs twice what a name of the module does."""
ERROR_BEHAVIOUR = {0: NmtState.PRE_OPERATIONAL, 2: NmtState.STOPPED}
"""Object 1029h:01: state after a communication error; 1 is no change."""


class _SdoOwner:
    """The interface that canopen's SDO server needs of its node, over our dictionary."""

    def __init__(self, dictionary: Dictionary) -> None:
        self.dictionary, self.object_dictionary = dictionary, dictionary.od

    def get_data(self, index: int, subindex: int, *, check_readable: bool) -> bytes:
        return self.dictionary.upload(index, subindex)

    def set_data(self, index: int, subindex: int, data: bytes, *, check_writable: bool) -> None:
        self.dictionary.download(index, subindex, bytes(data))


class _SdoNetwork:
    """The interface that canopen's SDO server needs of its network."""

    def __init__(self, send: Send) -> None:
        self._send = send

    def send_message(self, can_id: int, data: bytes) -> None:
        self._send(can_id, bytes(data))


class Node:
    """One device on the bus; drive and gauge override the hooks at the end of the class.

    Parameters
    ----------
    node_id : int
        1 to 126.
    eds : Path
        Its EDS file.
    send : callable
        Called with identifier and data of a frame to be sent.
    stall_tolerance_s : float
        Added to every timeout in wall-clock time, s, because a desktop kernel may stall a controller for longer than a
        real-time kernel would.

    Attributes
    ----------
    present : bool
        Whether the node is on the bus.
    muted_tpdo_cycles : int
        TPDOs still to be suppressed by an injected fault.
    muted_heartbeat : bool
        Whether an injected fault suppresses heartbeats.
    on_routes_changed : callable
        Called when an RPDO identifier has changed.
    """

    device_name = b"simulated node"
    required: ClassVar[dict[Key, str]] = {(0x1000, 0): "I", (0x1800, 1): "I", (0x1A00, 0): "B"}
    """Objects that the EDS must have, with the struct codes of their types."""
    assumed: ClassVar[dict[Key, int]] = {
        (0x1001, 0): 0,
        (0x1006, 0): 0,
        (0x1008, 0): 0,
        (0x1016, 1): 0,
        (0x1017, 0): 0,
        (0x1019, 0): 0,
        (0x1018, 4): 0,
        (0x1029, 1): 0,
        **{(0x1003, subindex): 0 for subindex in range(5)},
    }
    """Values used for objects that the EDS lacks."""

    def __init__(self, node_id: int, eds: Path, send: Send, stall_tolerance_s: float = 0.0) -> None:
        self.node_id = node_id
        self._eds, self._bus, self._stall_tolerance_s = eds, send, stall_tolerance_s
        self.present = True
        self.muted_tpdo_cycles = 0
        self.muted_heartbeat = False
        self.on_routes_changed: Callable[[], None] = lambda: None
        self._power_up()

    def _power_up(self) -> None:
        """Set everything to its state at power-on (also after an NMT reset)."""
        self.dictionary = Dictionary(self._eds, self.node_id, self.required, self.assumed)
        if self.dictionary.entry(*DEVICE_NAME).code is None:
            self.dictionary.entry(*DEVICE_NAME).value = self.device_name
        self.dictionary.entry(0x1018, 4).value = self.node_id
        self.dictionary.hooks[0x1016, 1] = self._restart_heartbeat_consumer
        self._sync_counter = SyncCounter(self.dictionary, lambda code: self.emergency(code, COMMUNICATION))
        self.nmt_state = NmtState.PRE_OPERATIONAL
        self._sdo = SdoServer(
            SDO_REQUEST_BASE + self.node_id, SDO_RESPONSE_BASE + self.node_id, _SdoOwner(self.dictionary)
        )
        self._sdo.network = _SdoNetwork(self.send)
        self.tpdo = self._make_pdo(0x1800, 0x1A00, receive=False)
        self.rpdo = self._make_pdo(0x1400, 0x1600, receive=True) if (0x1400, 0) in self.dictionary else None
        self._latched: bytes | None = None
        self._syncs = 0
        self._next_heartbeat_s = 0.0
        self._heartbeat_seen_s: float | None = None
        self._rpdo_seen_s: float | None = None
        self._rpdo_age_s = 0.0
        self.on_power_up()
        self.on_mapping_changed()

    def _make_pdo(self, communication: int, mapping: int, *, receive: bool) -> Pdo:
        try:
            return Pdo(
                self.dictionary,
                communication,
                mapping,
                receive=receive,
                may_change=lambda: self.nmt_state is NmtState.PRE_OPERATIONAL,
                on_change=self._pdo_changed,
            )
        except (KeyError, SdoAbortedError):
            expected = "expected objects that exist and can be mapped, or none"
            raise InputError(f"{self._eds}: default mapping in {mapping:04X}h cannot be used ({expected})") from None

    def _pdo_changed(self) -> None:
        self.on_routes_changed()
        self.on_mapping_changed()

    def send(self, cob_id: int, data: bytes) -> None:
        """Send a frame, if the node is on the bus."""
        if self.present:
            self._bus(cob_id, data)

    def boot(self) -> None:
        """Reset the node and send its boot-up message."""
        self._power_up()
        self.on_routes_changed()
        self.send(HEARTBEAT_BASE + self.node_id, bytes([NmtState.BOOT_UP]))

    def handle_nmt(self, command: int) -> None:
        """Execute an NMT command (its specifier) addressed to this node or to all."""
        if not self.present:
            return
        if command in NMT_RESETS:
            self.boot()
        elif command in NMT_COMMANDS:
            self.change_nmt_state(NMT_COMMANDS[command])

    def change_nmt_state(self, state: NmtState) -> None:
        """Enter an NMT state; for the application, leaving operational is a lost connection."""
        left_operational = self.nmt_state is NmtState.OPERATIONAL and state is not NmtState.OPERATIONAL
        self.nmt_state = state
        self._rpdo_seen_s = None
        self._sync_counter.restart()
        if left_operational:
            self.on_connection_lost(f"NMT state {state.name.lower().replace('_', '-')}")

    def handle_sdo(self, data: bytes) -> None:
        """Answer an SDO request of 8 bytes."""
        if self.present and self.nmt_state is not NmtState.STOPPED and len(data) == 8:
            self.refresh()
            self._sdo.on_request(SDO_REQUEST_BASE + self.node_id, data, 0.0)

    def handle_rpdo(self, data: bytes, now_s: float) -> None:
        """Receive a PDO at monotonic time `now_s`; a synchronous one takes effect at the SYNC."""
        rpdo = self.rpdo
        if rpdo is None or self.nmt_state is not _OPERATIONAL or not self.present:
            return
        if len(data) < rpdo.size:
            self.emergency(ERROR_PDO_LENGTH, COMMUNICATION)
            return
        self._rpdo_seen_s, self._rpdo_age_s = now_s, 0.0
        if rpdo.transmission_type <= MAX_SYNC_TYPE:
            self._latched = data
        else:
            rpdo.unpack(data)

    def accepts_sync(self, data: bytes) -> bool:
        """Return whether the node acts on a SYNC with these data; a node that is not operational checks nothing."""
        return self.nmt_state is not _OPERATIONAL or not self.present or self._sync_counter.accepts(data)

    def sample(self) -> None:
        """Run the first half of a SYNC: send the synchronous TPDO with the present values."""
        if self.nmt_state is not _OPERATIONAL or not self.present:
            return
        self.on_sample()
        if self.muted_tpdo_cycles:
            self.muted_tpdo_cycles -= 1
            return
        self._syncs += 1
        tpdo = self.tpdo
        if tpdo.valid and self._syncs % tpdo.transmission_type == 0:
            self._bus(tpdo.cob_id, tpdo.pack())

    def apply(self, dt_s: float) -> None:
        """Run the second half of a SYNC: take over the last RPDO for the coming cycle of `dt_s` seconds."""
        if self._latched is not None and self.rpdo is not None:
            self.rpdo.unpack(self._latched)
            self._latched = None
        self._rpdo_age_s += dt_s
        self.on_cycle(dt_s)

    def _restart_heartbeat_consumer(self, value: object) -> None:
        self._heartbeat_seen_s = None  # monitoring starts with the first heartbeat received after configuration

    def handle_heartbeat(self, producer: int, now_s: float) -> None:
        """Receive a heartbeat of node `producer` at monotonic time `now_s`."""
        if self.dictionary.number(0x1016, 1) >> 16 & 0x7F == producer:
            self._heartbeat_seen_s = now_s

    def poll(self, now_s: float) -> None:
        """Run everything that depends on wall-clock time: own heartbeat, heartbeat consumer, RPDO deadline."""
        if not self.present:
            return
        period_s = self.dictionary.number(0x1017) / 1000.0
        if period_s and now_s >= self._next_heartbeat_s:
            self._next_heartbeat_s = max(self._next_heartbeat_s + period_s, now_s)
            if not self.muted_heartbeat:
                self.send(HEARTBEAT_BASE + self.node_id, bytes([self.nmt_state]))
        limit_s = (self.dictionary.number(0x1016, 1) & 0xFFFF) / 1000.0
        seen_s = self._heartbeat_seen_s
        if limit_s and seen_s is not None and now_s - seen_s > limit_s + self._stall_tolerance_s:
            self.lose_connection(ERROR_HEARTBEAT, "controller's heartbeat lost")
        self._check_rpdo_deadline(now_s)

    def _check_rpdo_deadline(self, now_s: float) -> None:
        if self.rpdo is None or self._rpdo_seen_s is None or (0x1400, 5) not in self.dictionary:
            return
        limit_s = self.dictionary.number(0x1400, 5) / 1000.0
        late = now_s - self._rpdo_seen_s > limit_s + self._stall_tolerance_s or self._rpdo_age_s > limit_s
        if limit_s and late:
            self.lose_connection(ERROR_RPDO_TIMEOUT, "RPDO timed out")

    def lose_connection(self, error: int, reason: str) -> None:
        """React to the loss of the controller: EMCY, reaction of the application, NMT state by 1029h."""
        self._heartbeat_seen_s = self._rpdo_seen_s = None
        self.emergency(error, COMMUNICATION)
        self.on_connection_lost(reason)
        behaviour = ERROR_BEHAVIOUR.get(self.dictionary.number(0x1029, 1))
        if self.nmt_state is NmtState.OPERATIONAL and behaviour is not None:
            self.nmt_state = behaviour

    def emergency(self, code: int, register: int = GENERIC) -> None:
        """Send an EMCY and enter it in the error field 1003h; code 0 clears the error register."""
        entry = self.dictionary.entry(0x1001)
        entry.value = int(entry.value) | register | GENERIC if code else 0
        if code:
            newest_first = [code] + [self.dictionary.number(0x1003, k) for k in (1, 2, 3)]
            for subindex, value in enumerate(newest_first, start=1):
                self.dictionary.entry(0x1003, subindex).value = value
            count = self.dictionary.entry(0x1003, 0)
            count.value = min(int(count.value) + 1, 4)
            log.warning("node %d: EMCY %04Xh", self.node_id, code)
        if self.nmt_state is not NmtState.STOPPED:
            self.send(EMCY_BASE + self.node_id, code.to_bytes(2, "little") + bytes([int(entry.value)]) + bytes(5))

    def on_power_up(self) -> None:
        """Initialise the application; the dictionary has its defaults."""

    def on_mapping_changed(self) -> None:
        """Take note of what the PDOs carry now."""

    def refresh(self) -> None:
        """Update the dictionary for an SDO request between SYNCs."""

    def on_sample(self) -> None:
        """Write the present values into the dictionary, for the TPDO."""

    def on_cycle(self, dt_s: float) -> None:
        """Advance the application by one cycle of `dt_s` seconds."""

    def on_connection_lost(self, reason: str) -> None:
        """React to the loss of the controller."""
