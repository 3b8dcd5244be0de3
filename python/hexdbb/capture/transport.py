"""Open the CAN bus that a user names as ``interface:channel``, with any interface of python-can.

A socketcand server is spoken to by a client of our own (`hexdbb.capture.socketcand`), which says why.
"""

from __future__ import annotations

import socket
from typing import Any

import can

from hexdbb.capture.socketcand import SocketcandBus
from hexdbb.errors import InputError

EXAMPLES = "socketcan:can0, pcan:PCAN_USBBUS1, kvaser:0, socketcand:127.0.0.1:29536"
CONNECT_TIMEOUT_S = 3.0
"""Longest time to connect to a socketcand server, s: one lost SYN is repeated after 1 s, a second one after 3 s."""
DRIVER_ERRORS = (can.CanError, OSError, OverflowError, ImportError, ValueError, TypeError, NameError)
"""Exceptions of python-can's interfaces if bus, channel or a driver library is missing (kvaser: NameError)."""
SOCKETCAND_CHANNEL = "can0"
"""Channel requested from a socketcand server if the user names none."""


def open_bus(spec: str, bitrate_bit_s: int) -> can.BusABC:
    """Open a bus.

    Parameters
    ----------
    spec : str
        ``interface:channel[@bitrate]``; for socketcand ``socketcand:[channel@]host:port``.
    bitrate_bit_s : int
        Bit rate of the machine file, used if `spec` names none.

    Returns
    -------
    can.BusABC
        The open bus; the caller closes it.

    Raises
    ------
    InputError
        `spec` cannot be parsed, or the bus cannot be opened.
    """
    interface, separator, channel = spec.partition(":")
    if not separator or not channel or interface not in can.VALID_INTERFACES:
        raise InputError(f"--bus {spec}: cannot be parsed (expected interface:channel, for example {EXAMPLES})")
    try:
        if interface == "socketcand":
            return _socketcand(channel)
        return can.Bus(interface=interface, **_with_bitrate(channel, bitrate_bit_s))
    except DRIVER_ERRORS as error:
        raise InputError(
            f"--bus {spec}: cannot be opened: {one_line(error)} (expected a bus, for example {EXAMPLES})"
        ) from error


def one_line(error: Exception) -> str:
    """Return the first line of an error message without the traceback that some drivers of python-can append."""
    text = str(error).partition("Traceback (most recent call last)")[0].strip()
    return text.splitlines()[0].strip() if text else type(error).__name__


def _with_bitrate(channel: str, bitrate_bit_s: int) -> dict[str, Any]:
    """Parse ``channel[@bitrate]``."""
    name, _, bitrate = channel.partition("@")
    return {"channel": name, "bitrate": int(bitrate or bitrate_bit_s)}


def _socketcand(channel: str) -> SocketcandBus:
    """Open ``[channel@]host:port`` of a socketcand server."""
    remote, _, address = channel.rpartition("@")
    host, _, port = address.rpartition(":")
    if not host or not port.isdecimal():
        raise ValueError(f"address {address} is not host:port")
    connection = socket.create_connection((host, int(port)), CONNECT_TIMEOUT_S)
    try:
        return SocketcandBus(connection, remote or SOCKETCAND_CHANNEL)
    except BaseException:
        connection.close()
        raise
