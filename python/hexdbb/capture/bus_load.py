"""Bus load of one communication cycle.

Model: a classical CAN data frame with an 11-bit identifier and n data bytes has 8n + 47 bits and, at worst, one stuff
bit for every four of the 34 + 8n bits that are subject to stuffing: 8n + 47 + floor((34 + 8n - 1) / 4).
Assumption: every cycle carries SYNC (no data), one RPDO per drive and one TPDO per node; heartbeats are neglected.
Source: CAN 2.0A frame format; stuffing bound of Davis, Burns, Bril and Lukkien, Real-Time Systems 35 (2007).
"""

from __future__ import annotations

from collections.abc import Sequence

from hexdbb.capture.pdo import DRIVE_RPDO, DRIVE_TPDO, GAUGE_TPDO
from hexdbb.errors import InputError

MAX_LOAD = 0.8
"""Largest share of the bus that the process data may take at worst. The other 20 % carry heartbeats, EMCY, SDO during
pauses and repetitions after bit errors, which the load does not count."""


def frame_bits(data_bytes: int) -> int:
    """Return the worst-case number of bits of one frame with `data_bytes` (0 to 8) bytes of data."""
    return 8 * data_bytes + 47 + (34 + 8 * data_bytes - 1) // 4


def cycle_s(frame_bytes: Sequence[int], bitrate_bit_s: float) -> float:
    """Return the worst-case bus time (s) of one cycle whose frames carry `frame_bytes` bytes of data each."""
    return sum(frame_bits(n) for n in frame_bytes) / bitrate_bit_s


def configured_frames(drives: int) -> list[int]:
    """Return the data bytes of every frame of one cycle: SYNC, an RPDO and a TPDO per drive, the gauge's TPDO."""
    return [0, *[DRIVE_RPDO.bytes] * drives, *[DRIVE_TPDO.bytes] * drives, GAUGE_TPDO.bytes]


def check_load(rate_hz: float, bitrate_bit_s: float, drives: int) -> float:
    """Return the bus load of a cycle rate.

    Parameters
    ----------
    rate_hz : float
        Cycles per second.
    bitrate_bit_s : float
        Bit rate of the bus.
    drives : int
        Number of drives.

    Returns
    -------
    float
        Worst-case share of the bus, 0 to 1.

    Raises
    ------
    InputError
        The load exceeds `MAX_LOAD`; names cycle rate, bit rate and the highest cycle rate allowed.
    """
    busy_s = cycle_s(configured_frames(drives), bitrate_bit_s)
    load = rate_hz * busy_s
    if load > MAX_LOAD:
        raise InputError(
            f"cycle rate {rate_hz:g} Hz at {bitrate_bit_s:g} bit/s: bus load {load:.0%} "
            f"(expected at most {MAX_LOAD:.0%}, that is {MAX_LOAD / busy_s:.0f} Hz)"
        )
    return load
