"""Parts of records, as a short test has them: what they do not tell apart is not named for sure."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from hexdbb.discovery import discover
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case


def _part(name: str, circles: Sequence[int], *, slow: bool = False, forward: bool = False) -> Samples:
    """Return some circles of a record, of its slower feed or its one direction if asked."""
    record = case(name).record()
    whole = Samples.of([record])
    kept = np.isin(whole["circle"], circles)
    if slow:
        kept &= whole["feed_mm_s"] == whole["feed_mm_s"].min()
    if forward:
        kept &= whole["direction"] > 0
    return Samples.of([record.part(kept)])


@pytest.mark.long
def test_what_predicts_no_more_than_further_laps_is_not_named_for_sure() -> None:
    """A boot whose strain wears off, on three circles at one feed: six drives that lag explain it where fitted."""
    samples = _part("boot_relaxes-d0-x10-calibrate-s134", [1, 3, 5], slow=True)
    assert discover(samples, new_model(samples.machine), with_tables=False).verdict == "unknown"


def test_an_effect_that_lends_the_functions_of_anothers_form_is_named_beside_it() -> None:
    """A gauge of another gain, on four circles in one direction: one that drifts and is bent explains as much."""
    samples = _part("bar_gain-d20-x30-calibrate-s118", [0, 3, 6, 7], forward=True)
    found = discover(samples, new_model(samples.machine), known_only=True, with_tables=False)
    (cause,) = found.causes
    assert "bar_gain" in (cause.effect, *cause.rivals)
    assert cause.effect == "bar_gain" or found.verdict == "ambiguous"
