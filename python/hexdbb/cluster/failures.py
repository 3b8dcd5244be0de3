"""Tasks that failed among others, tried again by themselves; what fails for good is told by its error.

A task has three attempts: one among others, and two by itself (Dask's `retries`). Where a worker died, nobody knows
which of its tasks it died of, and Dask blames those that waited there too: each of them runs while no other does.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from hexdbb.cluster.part import Outcome, Work, described, run_alone
from hexdbb.cluster.submitted import Submitted

RETRIES = 1
"""Times that Dask tries a task again by itself, so that it is tried three times altogether."""


def run_singly(
    submitted: Submitted, work: Work, items: Mapping[str, Any], window: int
) -> Iterator[tuple[str, Outcome | str | None]]:
    """Run tasks one a call; yield the key of each with its rows, its error, or None where its worker died."""
    for key, outcome in submitted.each(items, lambda key: (run_alone, work, (key, items[key])), window, RETRIES):
        if isinstance(outcome, BaseException):
            yield key, None if submitted.is_death(outcome) else described(outcome)
        else:
            yield key, outcome


def run_apart(submitted: Submitted, work: Work, items: Mapping[str, Any]) -> Iterator[tuple[str, Outcome | str]]:
    """Run tasks one after the other, each while no other runs; yield the key of each with its rows or its error."""
    for key, outcome in submitted.each(items, lambda key: (run_alone, work, (key, items[key])), 1, RETRIES):
        if submitted.is_death(outcome):
            yield key, "its worker died each time (expected a task that fits in its memory)"
        elif isinstance(outcome, BaseException):
            yield key, described(outcome)
        else:
            yield key, outcome
