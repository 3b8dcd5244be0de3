"""Answers that come after the request was sent again are left out; answers to nothing asked are reported."""

from __future__ import annotations

from collections import deque

import canopen
import pytest
from canopen.sdo.exceptions import SdoCommunicationError

from hexdbb.capture.late_answers import PromptClient

READ_A = bytes.fromhex("4000210500000000")
ANSWER_A = bytes.fromhex("4300210500000000")
WRITE_B = bytes.fromhex("2301210501000000")
ANSWER_B = bytes.fromhex("6001210500000000")
ABORT_A = bytes.fromhex("8000210500000206")


class Node:
    """A bus with one node whose answers to each request are given beforehand."""

    def __init__(self, answers: list[list[bytes]]) -> None:
        self.client = PromptClient(0x607, 0x587, canopen.ObjectDictionary())
        self.client.RESPONSE_TIMEOUT, self.client.MAX_RETRIES = 0.01, 3
        self.client.network = self
        self.asked = 0
        self._answers = deque(answers)

    def send_message(self, _: int, request: bytes) -> None:
        self.asked += 1
        for answer in self._answers.popleft() if self._answers else []:
            self.client.on_response(0x587, answer, 0.0)


def test_the_second_answer_to_a_repeated_request_is_not_the_next_ones() -> None:
    node = Node([[], [ANSWER_A], [ANSWER_A, ANSWER_B]])
    assert node.client.request_response(READ_A) == ANSWER_A
    assert node.asked == 2
    assert node.client.request_response(WRITE_B) == ANSWER_B


def test_a_late_abort_does_not_end_the_next_transfer() -> None:
    node = Node([[], [ANSWER_A], [ABORT_A, ANSWER_B]])
    node.client.request_response(READ_A)
    assert node.client.request_response(WRITE_B) == ANSWER_B


def test_an_answer_to_what_was_never_asked_passes_to_be_reported() -> None:
    node = Node([[ANSWER_A]])
    assert node.client.request_response(WRITE_B) == ANSWER_A


def test_a_second_answer_to_one_request_passes_to_be_reported() -> None:
    node = Node([[ANSWER_A], [ANSWER_A]])
    node.client.request_response(READ_A)
    assert node.client.request_response(WRITE_B) == ANSWER_A


def test_a_node_that_never_answers_is_said_to() -> None:
    with pytest.raises(SdoCommunicationError, match="No SDO response"):
        Node([]).client.request_response(READ_A)
