"""Open the CAN bus a user names: ``interface:channel``, any interface of python-can.

A network bus is probed first: python-can would try a socketcand address that refuses connections for ten seconds,
silently.
"""

from __future__ import annotations

import socket
from collections.abc import Callable
from contextlib import ExitStack
from typing import Any

import can

from hexdbb.errors import InputError

EXAMPLES = "socketcan:can0, pcan:PCAN_USBBUS1, kvaser:0, socketcand:127.0.0.1:29536"
CONNECT_TIMEOUT_S = 3.0
DRIVER_ERRORS = (can.CanError, OSError, OverflowError, ImportError, ValueError, TypeError, NameError)
"""What python-can's interfaces raise where bus, channel or the maker's library is not there (kvaser: NameError)."""
SOCKETCAND_CHANNEL = "can0"


def open_bus(spec: str, bitrate_bit_s: int) -> can.BusABC:
    """Open a bus.

    Parameters
    ----------
    spec : ``interface:channel[@bitrate]``; for socketcand ``[channel@]host:port``
    bitrate_bit_s : bit rate of the machine file, where `spec` names none

    Raises
    ------
    InputError
        The text is not understood, or the bus is not there.
    """
    interface, separator, channel = spec.partition(":")
    if not separator or not channel or interface not in can.VALID_INTERFACES:
        raise InputError(f"--bus {spec}: not understood (expected interface:channel, for example {EXAMPLES})")
    with ExitStack() as until_open:
        try:
            arguments = ARGUMENTS.get(interface, _with_bitrate)(channel, bitrate_bit_s, until_open)
            return can.Bus(interface=interface, **arguments)
        except DRIVER_ERRORS as error:
            raise InputError(
                f"--bus {spec}: not there: {one_line(error)} (expected a bus, for example {EXAMPLES})"
            ) from error


def one_line(error: Exception) -> str:
    """Give the first line of what a library says; some of python-can's drivers put a traceback behind it."""
    said = str(error).strip()
    return said.splitlines()[0] if said else type(error).__name__


def _with_bitrate(channel: str, bitrate_bit_s: int, until_open: ExitStack) -> dict[str, Any]:
    """Read ``channel[@bitrate]``."""
    name, _, bitrate = channel.partition("@")
    return {"channel": name, "bitrate": int(bitrate or bitrate_bit_s)}


def _socketcand(channel: str, bitrate_bit_s: int, until_open: ExitStack) -> dict[str, Any]:
    """Read ``[channel@]host:port`` of a socketcand server, and see that it answers.

    The probe stays connected until the bus is open: a server may end when its last client leaves.
    """
    remote, _, address = channel.rpartition("@")
    host, _, port = address.rpartition(":")
    if not host or not port.isdecimal():
        raise ValueError(f"address {address} is not host:port")
    until_open.enter_context(socket.create_connection((host, int(port)), CONNECT_TIMEOUT_S))
    return {"host": host, "port": int(port), "channel": remote or SOCKETCAND_CHANNEL, "tcp_tune": True}


ARGUMENTS: dict[str, Callable[[str, int, ExitStack], dict[str, Any]]] = {"socketcand": _socketcand}
"""How an interface's channel text becomes its arguments, where it is not ``channel[@bitrate]``."""
