"""Nothing that comes from the bus raises past the boundary; stopping goes on whatever the bus does."""

from __future__ import annotations

import itertools
import random
import struct
import time

import can
import pytest
from tests.python.capture.scripted_bus import DRIVES, GAUGE, ScriptedBus, at_rest, axes_on

from hexdbb.capture.exchange import MAX_BACKLOG, Exchange, Feedback
from hexdbb.capture.frames import GuardedBus
from hexdbb.capture.link import Link
from hexdbb.capture.motion import AxisGroup, MotionFaultError
from hexdbb.capture.sdo import RemoteDevice
from hexdbb.capture.targets_ahead import Row
from hexdbb.capture.transport import one_line
from hexdbb.errors import RunError
from hexdbb.machine import shipped

ROWS = 20
FAULT_SYNC = 5
"""SYNC of the capture before whose answers a test puts its frames."""


class Kept:
    """Counts rows."""

    count = 0

    def keep(self, row: Row, feedback: Feedback) -> None:
        self.count += 1

    def settle(self, paired: bool, held: int) -> None:
        assert paired

    def pause(self) -> None:
        pass


def follow(axes: AxisGroup) -> int:
    """Follow standing targets; return the number of rows kept."""
    kept = Kept()
    axes.follow(at_rest(ROWS), kept, {})
    return kept.count


def moving(bus: ScriptedBus, *frames: tuple[int, bytes]) -> AxisGroup:
    """Enabled axes on a bus that puts frames before the answers to a later SYNC."""
    axes = axes_on(bus)
    axes.read_positions()
    axes.enable()
    start = bus.syncs
    bus.on_sync = lambda number: (
        [bus.put(*frame) for frame in frames] and None if number == start + FAULT_SYNC else None
    )
    return axes


@pytest.mark.parametrize(
    ("can_id", "data", "cause"),
    [
        (0x083, b"\x10\x23", r"node 3 \(slider 3\): EMCY 2310h, cut short to 2 bytes \(10 23\) \(expected none\)"),
        (0x083, b"\x10", r"node 3 \(slider 3\): EMCY of 1 bytes \(10\) \(expected 8\)"),
        (0x083, b"\x00\x00", r"node 3 \(slider 3\): EMCY of 2 bytes \(00 00\) \(expected 8\)"),
        (0x707, b"", r"node 7 \(gauge\): heartbeat of 0 bytes \(expected 1\)"),
        (0x000, b"\x80", r"bus: NMT command of 1 bytes \(80\) \(expected 2\)"),
        (0x582, b"\x43\x00\x10", r"node 2 \(slider 2\): SDO answer of 3 bytes \(43 00 10\) \(expected 8\)"),
    ],
)
def test_frame_cut_short_stops_the_axes_with_node_object_and_bytes(can_id: int, data: bytes, cause: str) -> None:
    bus = ScriptedBus()
    axes = moving(bus, (can_id, data))
    with pytest.raises(MotionFaultError, match=rf"^{cause}$"):
        follow(axes)
    assert axes.stop() == []


def test_frames_of_nodes_that_are_not_ours_are_no_fault() -> None:
    bus = ScriptedBus()
    assert follow(moving(bus, (0x0A0, b"\x10"), (0x720, b""), (0x5A0, b"\x01"), (0x7E4, b""), (0x320, b""))) == ROWS


@pytest.mark.parametrize("kind", [{"is_extended_id": True}, {"is_remote_frame": True}, {"is_error_frame": True}])
def test_other_frames_with_the_number_of_a_tpdo_are_no_answer(kind: dict[str, bool]) -> None:
    bus = ScriptedBus()
    exchange = Exchange(GuardedBus(bus), DRIVES, GAUGE, lambda *_: None)
    data = b"" if "is_remote_frame" in kind else struct.pack("<fB", 123.0, 0)
    bus.on_sync = lambda _: bus.put(0x180 + GAUGE, data, **kind)
    exchange.send_sync()
    feedback = exchange.collect(0.01)
    assert (feedback.missing, feedback.reading_um) == ((), 0.0)


def test_emergency_that_is_reset_at_once_is_kept() -> None:
    bus = ScriptedBus()
    axes = moving(bus, (0x084, bytes([0x10, 0x23, 0x03, 0, 0, 0, 0, 0])), (0x084, bytes(8)))
    cause = r"^node 4 \(slider 4\): EMCY 2310h, error register 03h, since reset by the node \(expected none\)$"
    with pytest.raises(MotionFaultError, match=cause):
        follow(axes)


@pytest.mark.parametrize("when", ["moving", "enabling"])
def test_boot_up_followed_at_once_by_operational_is_kept(when: str) -> None:
    bus, frames = ScriptedBus(), ((0x702, b"\x00"), (0x702, b"\x05"))
    if when == "moving":
        axes = moving(bus, *frames)
    else:
        axes = axes_on(bus)
        axes.read_positions()
        for frame in frames:
            bus.put(*frame)
        axes.enable()
    with pytest.raises(MotionFaultError, match=r"^node 2 \(slider 2\): heartbeat reports NMT state 0 "):
        follow(axes)


def test_emergency_that_the_fault_reset_has_settled_is_none() -> None:
    bus = ScriptedBus()
    bus.put(0x081, bytes([0x30, 0x81, 0x11, 0, 0, 0, 0, 0]))
    bus.put(0x081, bytes(8))
    axes = axes_on(bus)
    axes.read_positions()
    axes.enable()
    assert follow(axes) == ROWS


def test_emergency_of_another_node_during_enabling_is_in_the_message() -> None:
    bus = ScriptedBus()
    axes = axes_on(bus)
    axes.read_positions()
    bus.stuck = {2}
    bus.put(0x085, bytes([0x20, 0x33, 0x05, 0, 0, 0, 0, 0]))
    expected = (
        r"^node 2 \(slider 2\): object 6041:00 is 8240h, switch on disabled "
        r"\(expected ready to switch on within 2 s\); node 5 \(slider 5\) sent EMCY 3320h, error register 05h$"
    )
    with pytest.raises(RunError, match=expected):
        axes.enable()


@pytest.mark.parametrize(
    "error", [can.CanOperationError("no buffer space"), OSError(100, "network is down"), ValueError("x")]
)
@pytest.mark.parametrize("path", ["on_recv", "on_send"])
def test_stopping_goes_on_after_errors_of_the_bus(path: str, error: Exception) -> None:
    bus = ScriptedBus()
    axes = moving(bus)
    left = iter(range(7))

    def fail() -> None:
        if next(left, None) is not None:
            raise error

    setattr(bus, path, fail)
    assert axes.stop() == []
    assert set(bus.statusword.values()) == {0x8207}


def test_stopping_says_that_the_bus_is_lost_and_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("hexdbb.capture.motion.STOP_TIMEOUT_S", 0.05)
    bus = ScriptedBus()
    axes = moving(bus)

    def fail() -> None:
        raise can.CanOperationError("bus off  Traceback (most recent call last):\n  File ...")

    bus.on_send = fail
    (said,) = axes.stop()
    assert said.startswith("bus lost (bus off): the drives stop on their own")


def flood(bus: ScriptedBus) -> None:
    """Let a frame of no node wait at every read."""
    bus.on_recv = lambda: bus.put(0x7FF, b"") if not bus.waiting else None


def test_collecting_ends_under_a_flood_with_a_silent_node() -> None:
    bus = ScriptedBus()
    bus.silent = {3}
    flood(bus)
    exchange = Exchange(GuardedBus(bus), DRIVES, GAUGE, lambda *_: None)
    exchange.send_sync()
    assert exchange.collect(0.02).missing == (2,)


def test_draining_ends_under_a_flood_and_the_flood_is_a_fault() -> None:
    bus = ScriptedBus()
    axes = moving(bus)
    flood(bus)
    axes._loop.clock.real_time = True
    with pytest.raises(MotionFaultError, match=r"^bus: flooded with frames for 3 consecutive SYNCs"):
        follow(axes)
    assert axes.stop() == []


def test_answers_that_waited_while_this_process_stalled_are_read() -> None:
    bus = ScriptedBus()
    exchange = Exchange(GuardedBus(bus), DRIVES, GAUGE, lambda *_: None)
    exchange.send_sync()
    for _ in range(MAX_BACKLOG // 2):
        bus.waiting.appendleft(can.Message(arbitration_id=0x7FF, is_extended_id=False))
    stalled = [time.sleep]
    bus.on_recv = lambda: stalled.pop()(0.02) if stalled else None
    assert exchange.collect(0.01).missing == ()


def test_one_line_has_no_traceback() -> None:
    error = can.CanError("Failed to receive: x  Traceback (most recent call last):\n  File ...\nValueError: x")
    assert one_line(error) == "Failed to receive: x"


@pytest.mark.parametrize("seed", range(4))
def test_no_frame_raises_anything_but_a_fault(seed: int) -> None:
    rng = random.Random(seed)
    bus = ScriptedBus()
    axes = moving(bus)
    stopped = 0
    services = [0x000, 0x080, 0x100, 0x180, 0x200, 0x280, 0x580, 0x600, 0x700, 0x780]

    def noise(_: int) -> None:
        for _ in range(5):
            kind = rng.choice(
                [{}, {}, {}, {"is_extended_id": True}, {"is_remote_frame": True}, {"is_error_frame": True}]
            )
            data = b"" if "is_remote_frame" in kind else rng.randbytes(rng.randint(0, 8))
            bus.put(rng.choice(services) + rng.randrange(128), data, **kind)

    for _ in range(30):
        bus.on_sync = noise
        try:
            follow(axes)
        except MotionFaultError as error:
            assert "\n" not in str(error)
            stopped += 1
        bus.on_sync = lambda number: None
        assert axes.stop() == []
        axes._watch.supervision.malformed.clear()
        axes._watch.supervision.emergencies.clear()
        axes._watch.supervision.nmt_states.clear()
        axes.enable()
    assert stopped


@pytest.mark.parametrize("seed", range(4))
def test_no_sdo_answer_raises_anything_but_one_line(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("hexdbb.capture.sdo.SDO_TIMEOUT_S", 0.002)
    rng = random.Random(seed)
    bus = ScriptedBus()
    link = Link(bus)
    device = RemoteDevice(link, 3, "slider 3", shipped("eds", "hexglider_drive.eds"))

    def answer(can_id: int, data: bytes, remote: bool = False) -> None:
        """Answer like a server with flipped bits, of any length, or never to an end."""
        reply = bytearray(
            rng.choice([b"\x43\x00\x10\x00\x92\x01\x02\x00", b"\x41\x00\x10\x00\x09\0\0\0", b"\x00" * 8, b"\x10" * 8])
        )
        for _ in range(rng.randint(0, 2)):
            reply[rng.randrange(8)] ^= 1 << rng.randrange(8)
        link.notify(0x583, reply[: 8 if rng.random() < 0.9 else rng.randrange(8)], 0.0)

    monkeypatch.setattr(link, "send_message", answer)
    read = failed = 0
    for _ in range(250):
        try:
            device.read(0x1000) if rng.random() < 0.5 else device.write(0x6065, 0, 30000)
            read += 1
        except RunError as error:
            assert str(error).startswith("node 3 (slider 3): ")
            assert "\n" not in str(error)
            failed += 1
    assert read
    assert failed


def test_sdo_transfer_without_an_end_is_ended() -> None:
    link = Link(ScriptedBus())
    device = RemoteDevice(link, 3, "slider 3", shipped("eds", "hexglider_drive.eds"))
    toggle = itertools.cycle((b"\x00", b"\x10"))

    def answer(can_id: int, data: bytes, remote: bool = False) -> None:
        link.notify(0x583, bytearray(b"\x40\x00\x10\0\0\0\0\0" if data[0] == 0x40 else next(toggle) + bytes(7)), 0.0)

    link.send_message = answer
    assert device.read(0x1000) == 0
