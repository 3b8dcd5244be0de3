"""What a task is, how far a run of tasks is, and what it did; keys and seeds that follow from content."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Task:
    """One task.

    Attributes
    ----------
    key : str
        Hash of all that its rows follow from (`content_key`).
    payload : object
        What the function takes; it can be pickled.
    labels : mapping of str
        Values of columns that are known beforehand, for the row of a task that fails.
    """

    key: str
    payload: Any
    labels: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Progress:
    """How far a run is.

    Attributes
    ----------
    total, before, done, failed : int
        Tasks; done before this run; done in it, failed ones included; failed ones.
    elapsed_s : float
        Since its first task was handed out.
    """

    total: int
    before: int
    done: int
    failed: int
    elapsed_s: float

    @property
    def remaining_s(self) -> float | None:
        """Expected time to its end; None before the first task is done."""
        left = self.total - self.before - self.done
        return self.elapsed_s / self.done * left if self.done else None


@dataclass(frozen=True)
class Summary:
    """What a run did.

    Attributes
    ----------
    total, before, done, failed : int
        As in `Progress`.
    rows : int
        Rows written.
    elapsed_s, busy_s : float
        Time of the run from its first task on; time of the function, summed over the workers.
    peak_bytes : int
        Largest memory of a worker's process.
    """

    total: int
    before: int
    done: int = 0
    failed: int = 0
    rows: int = 0
    elapsed_s: float = 0.0
    busy_s: float = 0.0
    peak_bytes: int = 0


def content_key(*content: Any) -> str:
    """Return the key of a task: SHA-256 of what JSON can represent, independent of the order of a mapping's keys."""
    text = json.dumps(content, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


def seed_of(key: str) -> int:
    """Return the seed of a task, 63 bits of the hash of its key: the same wherever and whenever it runs."""
    return int.from_bytes(hashlib.sha256(key.encode()).digest()[:8], "big") >> 1
