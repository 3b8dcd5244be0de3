"""What the nodes really did, noted where they are connected: the truth that a record is judged by.

The frames are noted on the nodes' side of the proxy: answers before anything is done to them, commands after it.
"""

from __future__ import annotations

import struct
import time
from dataclasses import dataclass, field

from tests.faults.messages import Frame, Way

SYNC_ID, RPDO_BASE, TPDO_BASE = 0x080, 0x200, 0x180
DRIVES, GAUGE = range(1, 7), 7
ENABLED_MASK, ENABLED = 0x6F, 0x27
"""Statusword bits of *operation enabled* (CiA 402)."""
QUICK_STOP_MASK, QUICK_STOP = 0x86, 0x02
"""Controlword bits of *quick stop* (CiA 402)."""
SHUTDOWN_MASK, SHUTDOWN = 0x87, 0x06
"""Controlword bits of *shutdown* (CiA 402)."""
STANDING_SYNCS, STANDING_COUNTS = 5, 2
"""Last SYNCs of a run during which a drive that was stopped moves by no more than its encoder's rounding, counts."""


@dataclass
class Cycle:
    """One SYNC as the nodes received it.

    Attributes
    ----------
    time_s : float
        Monotonic time, s.
    targets : dict of int to int
        Targets (counts) that the drives had received last, by node id.
    commanded : dict of int to int
        Targets that the controller had sent last, by node id.
    positions : dict of int to int
        Positions (counts) in the drives' answers, by node id.
    reading_um : float or None
        The gauge's answer, µm.
    """

    time_s: float
    targets: dict[int, int]
    commanded: dict[int, int]
    positions: dict[int, int] = field(default_factory=dict)
    reading_um: float | None = None


@dataclass
class BusLog:
    """Notes every SYNC with its answers, and when all drives were enabled and told to stop.

    Attributes
    ----------
    cycles : list of Cycle
    enabled_at : int or None
        Number of the SYNC at which all six drives first answered that they are enabled.
    stopped_at : tuple of int and float, or None
        Number of SYNCs and monotonic time when the last of six drives received its quick stop.
    disabled : bool
        Whether a drive received *shutdown* after it was enabled: the run came to its regular end.
    """

    cycles: list[Cycle] = field(default_factory=list)
    enabled_at: int | None = None
    stopped_at: tuple[int, float] | None = None
    disabled: bool = False
    _targets: dict[int, int] = field(default_factory=dict)
    _commanded: dict[int, int] = field(default_factory=dict)
    _enabled: set[int] = field(default_factory=set)
    _stopping: set[int] = field(default_factory=set)

    @property
    def since_enabled(self) -> int | None:
        """Number of SYNCs since all drives were enabled, or None."""
        return None if self.enabled_at is None else len(self.cycles) - self.enabled_at

    def sent(self, frame: Frame) -> None:
        """Note a frame as the controller sent it."""
        node = frame.can_id - RPDO_BASE
        if node in DRIVES and len(frame.data) >= 6:
            self._commanded[node] = struct.unpack_from("<i", frame.data, 2)[0]

    def received(self, frame: Frame) -> None:
        """Note a frame as the nodes receive it."""
        if frame.can_id == SYNC_ID:
            self.cycles.append(Cycle(time.monotonic(), dict(self._targets), dict(self._commanded)))
            self._enabled.clear()
            return
        node = frame.can_id - RPDO_BASE
        if node not in DRIVES or len(frame.data) < 6:
            return
        controlword, self._targets[node] = struct.unpack_from("<Hi", frame.data)
        if self.enabled_at is not None and controlword & SHUTDOWN_MASK == SHUTDOWN:
            self.disabled = True
        if self.enabled_at is not None and controlword & QUICK_STOP_MASK == QUICK_STOP:
            self._stopping.add(node)
            if self.stopped_at is None and len(self._stopping) == len(DRIVES):
                self.stopped_at = len(self.cycles), time.monotonic()

    def answered(self, frame: Frame) -> None:
        """Note a frame as a node sends it."""
        node = frame.can_id - TPDO_BASE
        if not self.cycles or node not in range(1, 8):
            return
        cycle = self.cycles[-1]
        if node == GAUGE:
            cycle.reading_um = struct.unpack_from("<f", frame.data)[0]
            return
        word, cycle.positions[node] = struct.unpack_from("<Hi", frame.data)
        if self.enabled_at is None and word & ENABLED_MASK == ENABLED:
            self._enabled.add(node)
            if len(self._enabled) == len(DRIVES):
                self.enabled_at = len(self.cycles)

    def time_to_stop(self, at_s: float, cycle_s: float) -> tuple[float, float] | None:
        """Return cycles and seconds from a machine time since enabling to the quick stop, or None without one."""
        if self.enabled_at is None or self.stopped_at is None:
            return None
        begin = min(self.enabled_at + round(at_s / cycle_s), len(self.cycles)) - 1
        stopped_at, stopped_s = self.stopped_at
        return max(stopped_at - begin - 1, 0), max(stopped_s - self.cycles[begin].time_s, 0.0)

    def standing(self) -> bool:
        """Return whether every drive that answered the last SYNC stood still."""
        last = self.cycles[-STANDING_SYNCS:]
        for node in last[-1].positions if last else ():
            positions = [cycle.positions[node] for cycle in last if node in cycle.positions]
            if max(positions) - min(positions) > STANDING_COUNTS:
                return False
        return True

    @staticmethod
    def is_sync(frame: Frame, way: Way) -> bool:
        """Return whether a frame is a SYNC on its way to the nodes."""
        return frame.can_id == SYNC_ID and way is Way.TO_NODES
