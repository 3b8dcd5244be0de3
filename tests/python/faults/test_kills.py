"""A controller that is killed loses at most a second of samples, and nothing has to be tidied up by hand."""

from __future__ import annotations

import pytest
from tests.faults.kills import kill

SEED = 1


@pytest.mark.parametrize("share", [0.8, 0.95])
def test_killed_run_is_recovered_sample_by_sample(share: float) -> None:
    done = kill(share, SEED)
    assert done.unmet == (), done
    assert done.kept > 0


def test_run_killed_before_its_journal_holds_a_sample_can_be_repeated() -> None:
    done = kill(0.0, SEED, with_journal=True)
    assert done.unmet == (), done
