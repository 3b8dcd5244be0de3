"""A refined function in place of an effect that only the functions of its form make fit."""

from __future__ import annotations

import pytest
from tests.foreign_records import samples_of

from hexdbb.diagnosis import noise_of
from hexdbb.errors import RunError
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.verdict.by_function import or_by_refinements
from hexdbb.learned import Learned
from hexdbb.model import new_model
from hexdbb.samples.places import with_set_up_of


def test_a_dent_beside_legs_that_sag_is_no_bow() -> None:
    """A dent of 0.15 mm, 21 mm wide: as a bow it left three times the noise, by the functions of its form."""
    samples = samples_of("dent-beside-sag")
    model = with_set_up_of(samples, new_model(samples.machine))
    search = Search(Engine(samples, model, noise_of(samples), DEFAULT), ["gravity_sag", "straightness"], DEFAULT)
    sag = Member(Known("gravity_sag", tuple("123456"), is_whole=True))
    node = search.node((Member(Known("straightness", ("2",))), sag), near=search.root)
    (fine,) = search.tried(node, [search.screen(node).scored(Learned.parse("learned:vertical:2:fine_position"))])
    assert node.trial.left > 2.0 * fine.trial.left
    found, _ = or_by_refinements(search, node, fine)
    assert {*found.trial.names} == {"gravity_sag", "learned:vertical:2:fine_position"}
    # One cause alone keeps its name: of a bow of which geometry takes nearly all only its form is seen.
    alone = search.node((sag,), near=search.root)
    assert or_by_refinements(search, alone, fine) == (alone, fine)


def test_a_cause_with_more_splines_is_not_put_beside_itself() -> None:
    """A drive's target in steps of 21 µm was a bow and a function of its guideway: the verdict ended with an error."""
    samples = samples_of("dent-beside-sag")
    model = with_set_up_of(samples, new_model(samples.machine))
    search = Search(Engine(samples, model, noise_of(samples), DEFAULT), ["straightness"], DEFAULT)
    bow, dent = Member(Known("straightness", ("2",))), Learned.parse("learned:vertical:2:position")
    alone = search.node((bow,), near=search.root)
    screen = search.screen(alone)
    node, wider = (search.node((bow, search.member(screen.scored(each))), near=alone) for each in (dent, dent.finer(2)))
    assert node.trial.log_evidence < wider.trial.log_evidence
    assert or_by_refinements(search, node, wider) == (node, wider)
    with pytest.raises(RunError, match="twice"):
        search.node((node.members[1], wider.members[1]), near=node)
