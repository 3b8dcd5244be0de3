"""Messages of the socketcand text protocol as frames, and back.

Nodes to controller ``< frame ID TIME DATA >``, controller to nodes ``< send ID LENGTH BYTE BYTE … >``; everything else
(handshake, errors) is passed on as it is.
Source: socketcand protocol description (github.com/linux-can/socketcand).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import Enum


class Way(Enum):
    """Direction in which a message travels through the proxy."""

    TO_CONTROLLER = "to the controller"
    TO_NODES = "to the nodes"


@dataclass(frozen=True)
class Frame:
    """A CAN frame.

    Attributes
    ----------
    can_id : int
        Identifier, 11 bits.
    data : bytes
        Its data, at most eight bytes.
    """

    can_id: int
    data: bytes = b""

    def text(self, way: Way) -> bytes:
        """Return the message that carries the frame."""
        if way is Way.TO_CONTROLLER:
            return f"< frame {self.can_id:03X} 0.000000 {self.data.hex().upper()} >".encode()
        return f"< send {self.can_id:03X} {len(self.data):X} {self.data.hex(' ')} >".encode()


FRAME = re.compile(rb"< frame ([0-9A-F]{3}) [0-9.]+ ([0-9A-F]*) >")
SEND = re.compile(rb"< send ([0-9A-Fa-f]{3}) [0-8] ([0-9A-Fa-f ]*)>")


def split(received: bytes) -> tuple[list[bytes], bytes]:
    """Split received bytes into whole messages and the beginning of the next one."""
    *messages, rest = received.split(b">")
    return [message + b">" for message in messages], rest


def parse(message: bytes) -> Frame | None:
    """Return the frame that a message carries, or None."""
    match = FRAME.fullmatch(message)
    if match is not None:
        return Frame(int(match[1], 16), bytes.fromhex(match[2].decode()))
    match = SEND.fullmatch(message)
    if match is not None:
        return Frame(int(match[1], 16), bytes(int(byte, 16) for byte in match[2].split()))
    return None
