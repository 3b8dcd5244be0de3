"""One drive without a bus: its stops and the option codes that choose them."""

from __future__ import annotations

import struct

import pytest

from hexdbb.machine import shipped
from hexdbb.rig.cia402 import DriveState
from hexdbb.rig.drive import DriveNode, DriveSetup
from hexdbb.rig.node import ERROR_HEARTBEAT

SETUP = DriveSetup(10_000.0, (20.0, 846.0), 5.0, 400.0, 0.002, 0.0)
DT_S = 0.004


class Bench:
    """A drive with its frames; RPDOs go in as on the bus."""

    def __init__(self, setup: DriveSetup = SETUP) -> None:
        self.frames: list[tuple[int, bytes]] = []
        self.drive = DriveNode(
            3, shipped("eds", "hexglider_drive.eds"), lambda cob_id, data: self.frames.append((cob_id, data)), setup
        )
        self.set(0x6060, 8)
        self.drive.handle_nmt(0x01)
        self.at = self.drive.dictionary.number(0x6064)

    def set(self, index: int, value: int, subindex: int = 0) -> None:
        self.drive.dictionary.entry(index, subindex).value = value

    def cycle(self, controlword: int, target: int | None = None) -> None:
        self.at = self.at if target is None else target
        self.drive.handle_rpdo(struct.pack("<Hi", controlword, self.at), 0.0)
        self.drive.sample()
        self.drive.apply(DT_S)

    def moving(self) -> None:
        """Enabled and under way at 25 mm/s."""
        for word in (0x06, 0x07, 0x0F):
            self.cycle(word)
        for _ in range(25):
            self.cycle(0x0F, self.at + 1000)

    def until_standing(self, controlword: int) -> float:
        """Cycle until it stands; gives the way it took, mm."""
        begin = self.drive.axis.position_mm
        for _ in range(500):
            self.cycle(controlword)
            if self.drive.axis.at_standstill:
                return self.drive.axis.position_mm - begin
        raise AssertionError("does not stop")


@pytest.mark.parametrize(
    ("option", "state"),
    [
        (0, DriveState.OPERATION_ENABLED),
        (1, DriveState.FAULT),
        (2, DriveState.SWITCH_ON_DISABLED),
        (3, DriveState.SWITCH_ON_DISABLED),
    ],
)
def test_lost_connection_is_answered_as_6007_says(option, state):
    bench = Bench()
    bench.set(0x6007, option)
    bench.moving()
    bench.drive.lose_connection(ERROR_HEARTBEAT, "test")
    for _ in range(200):
        bench.drive.apply(DT_S)
    assert bench.drive.state is state
    assert (0x083, bytes([0x30, 0x81, 0x11, 0, 0, 0, 0, 0])) in bench.frames


def test_quick_stop_takes_the_ramp_of_6085():
    gentle, hard = Bench(), Bench()
    gentle.set(0x6085, 5_000_000)  # 500 mm/s2
    hard.set(0x6085, 50_000_000)
    for bench in (gentle, hard):
        bench.moving()
    speed, lag_mm = 25.0, 25.0 * SETUP.lag_s
    assert gentle.until_standing(0x02) == pytest.approx(speed**2 / 1000.0 + lag_mm, abs=1e-3)
    assert hard.until_standing(0x02) == pytest.approx(speed**2 / 10_000.0 + lag_mm, abs=1e-3)


@pytest.mark.parametrize(("option", "state"), [(2, DriveState.SWITCH_ON_DISABLED), (6, DriveState.QUICK_STOP_ACTIVE)])
def test_quick_stop_ends_as_605a_says(option, state):
    bench = Bench()
    bench.set(0x605A, option)
    bench.moving()
    bench.until_standing(0x02)
    bench.cycle(0x02)
    assert bench.drive.state is state


def test_own_stop_is_not_undone_by_a_controlword_that_stays():
    bench = Bench()
    bench.set(0x605A, 6)
    bench.moving()
    bench.drive.quick_stop()
    bench.until_standing(0x0F)
    assert bench.drive.state is DriveState.QUICK_STOP_ACTIVE
    bench.cycle(0x02)
    bench.cycle(0x0F)
    assert bench.drive.state is DriveState.OPERATION_ENABLED


def test_halt_stops_within_operation_enabled_and_says_it_does_not_follow():
    bench = Bench()
    bench.moving()
    bench.until_standing(0x010F)
    bench.cycle(0x010F)
    assert bench.drive.state is DriveState.OPERATION_ENABLED
    assert not bench.drive.dictionary.number(0x6041) & 0x1000


def test_fault_ramps_down_before_the_state_is_fault():
    bench = Bench()
    bench.set(0x6085, 1_000_000)
    bench.moving()
    bench.drive.trip()
    bench.cycle(0x0F)
    assert bench.drive.state is DriveState.FAULT_REACTION_ACTIVE
    bench.until_standing(0x0F)
    assert bench.drive.state is DriveState.FAULT
    assert bench.drive.dictionary.number(0x603F) == 0x2310


def test_drive_that_counts_the_other_way():
    bench = Bench(DriveSetup(-10_000.0, (20.0, 846.0), 5.0, 400.0, 0.002, 0.0))
    assert bench.at == -4_000_000
    limits = [bench.drive.dictionary.number(0x607D, k) for k in (1, 2)]
    assert limits == [-8_460_000, -200_000]
    for word in (0x06, 0x07, 0x0F):
        bench.cycle(word)
    for _ in range(25):
        bench.cycle(0x0F, bench.at - 1000)
    bench.cycle(0x0F)
    assert bench.drive.axis.position_mm == pytest.approx(402.5, abs=0.1)
    bench.drive.refresh()  # as for an SDO request: the TPDO does not carry the velocity
    assert bench.drive.dictionary.number(0x606C) < 0


def test_short_rpdo_is_an_emcy_and_moves_nothing():
    bench = Bench()
    bench.drive.handle_rpdo(b"\x06\x00", 0.0)
    assert bench.frames[-1][0] == 0x083
    assert struct.unpack_from("<H", bench.frames[-1][1])[0] == 0x8210
