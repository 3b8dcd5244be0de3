"""Answers to service data requests (SDO) that come after the request was sent again.

A node that is stalled for longer than the controller waits answers the first request and its repetition. The second
answer then meets the next request, of another object. It is known by what it answers and is left out; an answer to what
was never asked passes, so that a node that answers wrongly is reported.
Source: CiA 301, SDO protocol: command specifiers in the upper three bits, index and sub-index in bytes 1 to 3.
"""

from __future__ import annotations

from collections import Counter

import canopen

DOWNLOAD_REQUEST, UPLOAD_REQUEST = 1, 2
"""Command specifiers of requests that begin a transfer and name an object."""
ANSWERS = {DOWNLOAD_REQUEST: 3, UPLOAD_REQUEST: 2}
"""Command specifiers of the answers to them."""
ABORT = 4

Key = tuple[int, bytes]
"""Command specifier of an answer, index and sub-index of the object."""


class PromptClient(canopen.sdo.SdoClient):
    """A client of one node to which late answers do not count."""

    def __init__(self, *arguments: object) -> None:
        super().__init__(*arguments)
        self._asked: Key | None = None
        self._unanswered: Counter[Key] = Counter()

    def send_request(self, request: bytes) -> None:
        """Send a request, and remember which answer is due."""
        specifier = request[0] >> 5
        self._asked = (ANSWERS[specifier], bytes(request[1:4])) if specifier in ANSWERS else None
        if self._asked is not None:
            self._unanswered[self._asked] += 1
        super().send_request(request)

    def on_response(self, can_id: int, data: bytes, timestamp: float) -> None:
        """Take an answer, unless it is a late one."""
        if not self._is_late(bytes(data)):
            super().on_response(can_id, data, timestamp)

    def _is_late(self, answer: bytes) -> bool:
        if len(answer) < 4:
            return False
        specifier, place = answer[0] >> 5, answer[1:4]
        specifiers = tuple(ANSWERS.values()) if specifier == ABORT else (specifier,)
        due = [(each, place) for each in specifiers if self._unanswered[each, place] > 0]
        if not due:
            return False
        answered = self._asked if self._asked in due else due[0]
        self._unanswered[answered] -= 1
        return answered != self._asked
