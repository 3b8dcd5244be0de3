"""Of two looks at the same readings the one that says more, as surely, counts."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from hexdbb.discovery.look import Look
from hexdbb.evidence.criteria import DEFAULT


def _look(grade: str, causes: int, score: float, *, noise_mm: float = 5e-4, surely: bool = True) -> Look:
    found = tuple(SimpleNamespace(grade="effect" if surely else "ambiguous") for _ in range(causes))
    node = SimpleNamespace(score=score, trial=SimpleNamespace(left=1.0))
    engine = SimpleNamespace(readings=range(1000), noise=SimpleNamespace(sigma_mm=noise_mm))
    search = SimpleNamespace(engine=engine, criteria=DEFAULT)
    return Look(
        cast("Any", None), cast("Any", search), cast("Any", SimpleNamespace(grade=grade, found=found, node=node))
    )


@pytest.mark.parametrize(
    ("one", "other", "is_better"),
    [
        (_look("none", 0, -500.0), _look("unknown", 1, -600.0), True),
        (_look("effect", 1, -500.0), _look("ambiguous", 2, -600.0), True),
        (_look("unknown", 1, -500.0), _look("unknown", 2, -600.0), True),
        (_look("unknown", 2, -500.0), _look("unknown", 1, -600.0), False),  # one value more fits whatever is left
        (_look("unknown", 2, -500.0), _look("unknown", 0, -600.0), True),  # nothing tried explained it
        (_look("unknown", 1, -500.0), _look("ambiguous", 1, -600.0), False),
        (_look("effect", 1, -597.0), _look("ambiguous", 1, -600.0), False),  # hardly more evidence
        # Judged by half of the noise: by that of the other look what is left costs 375 nats less.
        (_look("effect", 1, -2000.0, noise_mm=2.5e-4), _look("ambiguous", 1, -1700.0), True),
        (_look("effect", 1, -2000.0), _look("ambiguous", 1, -1700.0), False),
    ],
)
def test_a_look_is_better_that_says_more_as_surely(one: Look, other: Look, is_better: bool) -> None:
    assert one.is_better(other) is is_better


def test_causes_that_are_all_for_sure_need_no_other_look() -> None:
    assert _look("effect", 3, 0.0).is_sure
    assert _look("none", 0, 0.0).is_sure
    assert not _look("effect", 2, 0.0, surely=False).is_sure
    assert not _look("unknown", 1, 0.0).is_sure
