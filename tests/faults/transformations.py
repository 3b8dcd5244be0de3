"""What a proxy may do to a frame: small transformations, each from one frame to the messages sent in its place.

A transformation returns emissions; an emission leaves now, after a number of SYNCs, after a time, or after the next
message of its direction. A rule joins a transformation to the frames it is for.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from tests.faults.messages import Frame, Way

FOREVER = 10**9
"""Number of frames that no run has."""


@dataclass(frozen=True)
class Emission:
    """A message to be sent.

    Attributes
    ----------
    message : bytes
        Its text; None breaks the connection instead.
    way : Way
        Direction.
    syncs : int
        Number of SYNCs that pass before it leaves.
    seconds : float
        Wall-clock time before it leaves, s.
    messages : int
        Number of messages of the same direction that leave before it.
    """

    message: bytes | None
    way: Way
    syncs: int = 0
    seconds: float = 0.0
    messages: int = 0


Transformation = Callable[[Frame, Way, random.Random], list[Emission]]


@dataclass
class Rule:
    """A transformation and the frames it is applied to.

    Attributes
    ----------
    can_id : int
        Identifier of the frames.
    way : Way
        Their direction.
    apply : callable
        The transformation.
    at_s : float or None
        Machine time since all six drives were first enabled, s, from which on frames are transformed; None from the
        first frame on.
    count : int
        Number of frames transformed.
    every : int
        One of this many matching frames is transformed.
    fired : int
        Frames transformed so far.
    """

    can_id: int
    way: Way
    apply: Transformation
    at_s: float | None = None
    count: int = 1
    every: int = 1
    fired: int = 0
    seen: int = field(default=0, repr=False)

    def matches(self, frame: Frame, way: Way, running_s: float | None) -> bool:
        """Count a frame and return whether it is to be transformed, `running_s` after the drives were enabled."""
        if frame.can_id != self.can_id or way is not self.way or self.fired >= self.count:
            return False
        if self.at_s is not None and (running_s is None or running_s < self.at_s - 1e-9):
            return False
        self.seen += 1
        if (self.seen - 1) % self.every:
            return False
        self.fired += 1
        return True

    def fresh(self, at_s: float | None) -> Rule:
        """Return the rule as it was before any frame, beginning at another time."""
        return replace(self, at_s=at_s, fired=0, seen=0)


def drop(frame: Frame, way: Way, rng: random.Random) -> list[Emission]:
    """Send nothing."""
    return []


def twice(frame: Frame, way: Way, rng: random.Random) -> list[Emission]:
    """Send the frame twice."""
    return [Emission(frame.text(way), way)] * 2


def after_next(frame: Frame, way: Way, rng: random.Random) -> list[Emission]:
    """Send the frame after the next one."""
    return [Emission(frame.text(way), way, messages=1)]


def break_connection(frame: Frame, way: Way, rng: random.Random) -> list[Emission]:
    """Break the connection."""
    return [Emission(None, way)]


def late(*, syncs: int = 0, seconds: float = 0.0) -> Transformation:
    """Return the transformation that sends a frame later."""
    return lambda frame, way, rng: [Emission(frame.text(way), way, syncs=syncs, seconds=seconds)]


def changed(change: Callable[[bytes], bytes]) -> Transformation:
    """Return the transformation that changes the data of a frame."""
    return lambda frame, way, rng: [Emission(Frame(frame.can_id, change(frame.data)).text(way), way)]


def bits_flipped(first_byte: int, last_byte: int, bits: int = 1) -> Transformation:
    """Return the transformation that flips random bits between two bytes of the data, both included."""

    def flip(frame: Frame, way: Way, rng: random.Random) -> list[Emission]:
        data = bytearray(frame.data)
        for bit in rng.sample(range(8 * first_byte, 8 * min(last_byte + 1, len(data))), bits):
            data[bit // 8] ^= 1 << bit % 8
        return [Emission(Frame(frame.can_id, bytes(data)).text(way), way)]

    return flip


def replaced_by(message: bytes) -> Transformation:
    """Return the transformation that sends a text in place of a frame."""
    return lambda frame, way, rng: [Emission(message, way)]


def followed_by(*others: Frame, to_nodes: bool = False, seconds: float = 0.0) -> Transformation:
    """Return the transformation that sends further frames after a frame, as if another node had sent them.

    Parameters
    ----------
    *others : Frame
        Sent to the controller.
    to_nodes : bool
        Whether the nodes receive them too, as they would on a real bus.
    seconds : float
        Time between the frame and the others, s.
    """

    def follow(frame: Frame, way: Way, rng: random.Random) -> list[Emission]:
        ways = (Way.TO_CONTROLLER, Way.TO_NODES) if to_nodes else (Way.TO_CONTROLLER,)
        extra = [Emission(other.text(each), each, seconds=seconds) for other in others for each in ways]
        return [Emission(frame.text(way), way), *extra]

    return follow


def flooded(other: Frame, per_second: int, seconds: float, silent: bool = False) -> Transformation:
    """Return the transformation that sends a frame to the controller again and again, in bursts of a millisecond.

    Parameters
    ----------
    other : Frame
    per_second : int
        Frames in a second.
    seconds : float
        Duration, s.
    silent : bool
        Whether the frame that sets it off is dropped.
    """

    def flood(frame: Frame, way: Way, rng: random.Random) -> list[Emission]:
        burst = other.text(Way.TO_CONTROLLER) * max(1, per_second // 1000)
        bursts = [Emission(burst, Way.TO_CONTROLLER, seconds=k / 1000) for k in range(round(1000 * seconds))]
        return bursts if silent else [Emission(frame.text(way), way), *bursts]

    return flood
