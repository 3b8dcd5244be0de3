"""Known effects alone: faster, and said to be no more than that."""

from __future__ import annotations

from hexdbb.discovery import discover
from hexdbb.discovery.words import KNOWN_ALONE
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case


def test_a_cause_found_among_known_effects_alone_says_what_was_not_tried() -> None:
    record = case("joint_friction-d10-x10-calibrate-s0").record()
    samples, model = Samples.of([record]), new_model(record.machine)
    alone = discover(samples, model, known_only=True, with_tables=False)
    assert [each.effect for each in alone.causes] == ["joint_friction"]
    assert KNOWN_ALONE in alone.remarks
    assert KNOWN_ALONE not in discover(samples, model, with_tables=False).remarks
