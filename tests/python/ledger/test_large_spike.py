"""A stiction thirty times the noise, a fifth off its formula: the fit must not end at the other sign of its height."""

from __future__ import annotations

from hexdbb.ledger import add_effect
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case


def test_the_fit_of_a_large_spike_ends_at_the_lower_of_two_minima() -> None:
    samples = Samples.of([case("reversal_spike-d20-x30-judge-s25").record()])
    added = add_effect(samples, new_model(samples.machine).with_mounts(samples.mounts), "reversal_spike:6")
    values = dict(zip([each.name for each in added.model.parameters()][-3:], added.model.values[-3:], strict=True))
    assert values["height"] > 0.1
    assert added.rms_after_um < 0.25 * added.rms_before_um
