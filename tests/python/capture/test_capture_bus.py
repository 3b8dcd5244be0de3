"""Parts that need no rig: bus load, PDO layouts, bus names, cycle times, statusword, deadlines."""

from __future__ import annotations

import time

import pytest

from hexdbb.capture.bus_load import check_load, configured_frames, cycle_s, frame_bits
from hexdbb.capture.cia402 import DriveState, state_of
from hexdbb.capture.clock import Deadlines
from hexdbb.capture.pdo import DRIVE_RPDO, DRIVE_TPDO, GAUGE_TPDO
from hexdbb.capture.settings import check_counts, interpolation_period
from hexdbb.capture.transport import open_bus
from hexdbb.errors import InputError
from hexdbb.machine import shipped_machine


@pytest.mark.parametrize(("data_bytes", "bits"), [(0, 55), (4, 95), (6, 115), (8, 135)])
def test_worst_case_frame_bits(data_bytes: int, bits: int) -> None:
    assert frame_bits(data_bytes) == bits


@pytest.mark.parametrize(
    ("frames", "us", "hz_at_70_percent"),
    [
        ([0, *[8] * 13], 1810, 387),
        ([0, *[6] * 12, 4], 1530, 458),
        ([0, *[8] * 3, *[6] * 6, 4], 1245, 562),
    ],
)
def test_cycle_time_of_three_layouts(frames: list[int], us: int, hz_at_70_percent: int) -> None:
    busy_s = cycle_s(frames, 1e6)
    assert busy_s * 1e6 == pytest.approx(us)
    assert round(0.7 / busy_s) == pytest.approx(hz_at_70_percent, abs=1)


def test_configured_layout_and_its_load() -> None:
    assert (DRIVE_RPDO.bytes, DRIVE_TPDO.bytes, GAUGE_TPDO.bytes) == (6, 7, 5)
    assert [mapped.entry for mapped in DRIVE_TPDO.objects] == [0x60410010, 0x60640020, 0x60610008]
    assert sorted(configured_frames(6)) == [0, 5, *[6] * 6, *[7] * 6]
    assert check_load(250.0, 1e6, 6) == pytest.approx(0.4)


@pytest.mark.parametrize(("rate_hz", "bitrate"), [(501.0, 1_000_000), (250.0, 250_000)])
def test_load_above_the_budget_is_refused_with_the_rate_that_fits(rate_hz: float, bitrate: int) -> None:
    with pytest.raises(
        InputError, match=rf"cycle rate {rate_hz:g} Hz at .*expected at most 80%, that is {bitrate / 2000:.0f} Hz"
    ):
        check_load(rate_hz, bitrate, 6)


@pytest.mark.parametrize(("rate_hz", "expected"), [(250, (4, -3)), (400, (25, -4)), (40, (25, -3)), (800, (125, -5))])
def test_interpolation_period_is_exact(rate_hz: float, expected: tuple[int, int]) -> None:
    units, exponent = interpolation_period(1.0 / rate_hz)
    assert (units, exponent) == expected
    assert units * 10.0**exponent == pytest.approx(1.0 / rate_hz, rel=1e-12)


def test_cycle_time_that_no_interpolation_period_gives_is_refused() -> None:
    with pytest.raises(InputError, match=r"cycle rate 333 Hz: the period 3\.003 ms does not fit object 60C2h"):
        interpolation_period(1.0 / 333.0)


def test_scale_that_overflows_the_target_object_is_refused() -> None:
    machine = shipped_machine()
    can_setup = machine.can_setup.model_copy(update={"counts_per_mm": 1e7})
    with pytest.raises(InputError, match=r"can\.counts_per_mm: 1e\+07 \(expected at most"):
        check_counts(machine.model_copy(update={"can": can_setup}))


@pytest.mark.parametrize(
    ("statusword", "state"),
    [
        (0x0000, DriveState.NOT_READY),
        (0x0250, DriveState.SWITCH_ON_DISABLED),
        (0x0231, DriveState.READY_TO_SWITCH_ON),
        (0x0233, DriveState.SWITCHED_ON),
        (0x1237, DriveState.OPERATION_ENABLED),
        (0x0217, DriveState.QUICK_STOP_ACTIVE),
        (0x021F, DriveState.FAULT_REACTION),
        (0x0218, DriveState.FAULT),
    ],
)
def test_state_of_statusword(statusword: int, state: DriveState) -> None:
    assert state_of(statusword) is state


@pytest.mark.parametrize(
    ("spec", "named"),
    [
        ("socketcand", "cannot be parsed"),
        ("nothing:can0", "cannot be parsed"),
        ("socketcand:127.0.0.1", "address 127.0.0.1 is not host:port"),
        ("socketcand:127.0.0.1:1", "Connection refused"),
        ("socketcan:no-such-bus0", "cannot be opened"),
        ("kvaser:0", "cannot be opened"),
        ("pcan:PCAN_USBBUS1@fast", "fast"),
    ],
)
def test_bus_that_is_not_there_is_one_line(spec: str, named: str) -> None:
    with pytest.raises(InputError, match=named) as caught:
        open_bus(spec, 1_000_000)
    assert str(caught.value).startswith(f"--bus {spec}: ")
    assert "\n" not in str(caught.value)


def test_missed_slots_are_skipped_and_counted_never_made_up_for() -> None:
    cycle = 0.05
    clock = Deadlines(cycle)
    clock.start()
    begun_s = time.monotonic()
    slots = sum(1 + clock.wait() for _ in range(3))
    time.sleep(4.5 * cycle)
    missed = clock.wait()
    assert missed >= 3
    slots += 1 + missed + sum(1 + clock.wait() for _ in range(3))
    # Slots keep pace with time: were the missed ones sent in a burst, there would be more of them than time has passed.
    assert slots - 1 <= (time.monotonic() - begun_s) / cycle
