"""SYNC counter of a node: object 1019h, and what a SYNC that does not fit it means.

Source: CiA 301, 1019h (synchronous counter overflow value): 0 for SYNCs without data; 2 to 240 for SYNCs of one byte
that counts from 1 to this value and begins anew. It may be changed only while the SYNC period 1006h is 0. EMCY 8240h:
unexpected SYNC data length. What a node does with a number out of sequence is its maker's choice: here a repeated one
is ignored, as CAN may repeat a frame, and any other is reported and followed, so that the axes can still be stopped.
"""

from __future__ import annotations

from collections.abc import Callable

from canopen.sdo import SdoAbortedError

from hexdbb.rig.dictionary import ABORT_DEVICE_STATE, ABORT_VALUE_RANGE, Dictionary, Value

OVERFLOW = 0x1019
ERROR_PROTOCOL, ERROR_SYNC_LENGTH = 0x8200, 0x8240
"""EMCY error codes."""
LARGEST = 240


class SyncCounter:
    """Checks the SYNCs that a node receives.

    Parameters
    ----------
    dictionary : Dictionary
        The node's dictionary; a write hook for 1019h is added to it.
    emergency : callable
        Sends an EMCY with an error code.
    """

    def __init__(self, dictionary: Dictionary, emergency: Callable[[int], None]) -> None:
        self._dictionary, self._emergency = dictionary, emergency
        self._overflow, self._has_object = dictionary.entry(OVERFLOW), (OVERFLOW, 0) in dictionary
        self._last: int | None = None
        dictionary.hooks[OVERFLOW, 0] = self._written

    def restart(self) -> None:
        """Take the next number as the first: after the node was started or its SYNCs were interrupted."""
        self._last = None

    def accepts(self, data: bytes) -> bool:
        """Return whether the node acts on a SYNC with these data."""
        overflow = int(self._overflow.value)
        if self._has_object and len(data) != bool(overflow):
            self._emergency(ERROR_SYNC_LENGTH)
            return False
        if not overflow:
            return True
        number, last = data[0], self._last
        self._last = number
        if number == last:
            return False
        if last is not None and number != last % overflow + 1:
            self._emergency(ERROR_PROTOCOL)
        return True

    def _written(self, value: Value) -> None:
        if self._dictionary.number(0x1006):
            raise SdoAbortedError(ABORT_DEVICE_STATE)
        if int(value) == 1 or int(value) > LARGEST:
            raise SdoAbortedError(ABORT_VALUE_RANGE)
        self._last = None
