"""Several faults at once, among known effects alone."""

from __future__ import annotations

from hexdbb import _core
from hexdbb.diagnosis import judging_noise
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.engine import Engine
from hexdbb.evidence.search import Search
from hexdbb.evidence.verdict import judge
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case


def test_a_third_cause_is_sought_where_two_explain_all_and_do_not_predict_it() -> None:
    """A bow of another guideway and the pitch error leave 1 % of the unexplained, and miss circles left out by 10."""
    record = case("pitch_cyclic+lead_error+straightness-d10-x3-calibrate-s3").record()
    samples = Samples.of([record])
    model = new_model(record.machine).with_mounts(samples.mounts)
    engine = Engine(samples, model, judging_noise(samples).noise)
    verdict = judge(Search(engine, _core.effect_names("catalogue"), DEFAULT, learns=False))
    assert verdict.grade == "effect"
    assert {each.hypothesis.name for each in verdict.found} == {"pitch_cyclic:4", "lead_error:2", "straightness:2"}
    assert verdict.refined is verdict.node
