"""CAN frames, and the identifiers of the CANopen predefined connection set.

Source: CiA 301, predefined connection set: identifier = function code + node id.
"""

Frame = tuple[int, bytes]
"""Identifier (11 bits) and up to 8 data bytes."""

NMT, SYNC = 0x000, 0x080
EMCY_BASE, SDO_RESPONSE_BASE, SDO_REQUEST_BASE, HEARTBEAT_BASE = 0x80, 0x580, 0x600, 0x700
"""Identifiers of node 0."""
