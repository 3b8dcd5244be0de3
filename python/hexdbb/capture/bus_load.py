"""How much of the bus one cycle takes.

Model: a classical CAN data frame with 11-bit identifier and n data bytes has 8n + 47 bits and, at worst, one stuff
bit for every four of the 34 + 8n bits that are stuffed: 8n + 47 + floor((34 + 8n - 1) / 4).
Assumption: every cycle carries SYNC (no data), one RPDO per drive and one TPDO per node; heartbeats are small beside
them.
Source: CAN 2.0A frame format; the stuffing bound of Davis, Burns, Bril and Lukkien (2007).
"""

from __future__ import annotations

from collections.abc import Sequence

from hexdbb.capture.pdo import DRIVE_RPDO, DRIVE_TPDO, GAUGE_TPDO
from hexdbb.errors import InputError

MAX_LOAD = 0.8
"""Share of the bus above which a configuration is refused."""


def frame_bits(data_bytes: int) -> int:
    """Worst-case bits of one frame with `data_bytes` bytes of data."""
    return 8 * data_bytes + 47 + (34 + 8 * data_bytes - 1) // 4


def cycle_s(frame_bytes: Sequence[int], bitrate_bit_s: float) -> float:
    """Worst-case time of one cycle whose frames carry `frame_bytes` bytes each."""
    return sum(frame_bits(n) for n in frame_bytes) / bitrate_bit_s


def configured_frames(drives: int) -> list[int]:
    """Bytes of every frame of one cycle: SYNC, an RPDO and a TPDO per drive, the gauge's TPDO."""
    return [0, *[DRIVE_RPDO.bytes] * drives, *[DRIVE_TPDO.bytes] * drives, GAUGE_TPDO.bytes]


def check_load(rate_hz: float, bitrate_bit_s: float, drives: int) -> float:
    """Return the bus load of a cycle rate, 0 to 1.

    Raises
    ------
    InputError
        The load is above `MAX_LOAD`: names rate, bit rate and the highest rate that fits.
    """
    busy_s = cycle_s(configured_frames(drives), bitrate_bit_s)
    load = rate_hz * busy_s
    if load > MAX_LOAD:
        raise InputError(
            f"cycle rate {rate_hz:g} Hz at {bitrate_bit_s:g} bit/s: bus load {load:.0%} "
            f"(expected at most {MAX_LOAD:.0%}, that is {MAX_LOAD / busy_s:.0f} Hz)"
        )
    return load
