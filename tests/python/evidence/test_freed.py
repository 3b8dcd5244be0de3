"""A search's arrays go as soon as nobody uses them: a worker judges thousands of records one after the other."""

from __future__ import annotations

import gc
import weakref
from pathlib import Path

import numpy as np

from hexdbb.diagnosis import judging_noise
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.search import Search
from hexdbb.model import new_model
from hexdbb.record import read_record
from hexdbb.samples import Samples

RECORD = Path(__file__).parents[2] / "data" / "foreign" / "joint-friction-3x.parquet"


def test_an_engine_and_its_search_hold_each_other_in_no_circle() -> None:
    record = read_record(RECORD)
    samples = Samples.of([record.part(np.arange(len(record)) % 20 == 3)])
    model = new_model(samples.machine).with_mounts(samples.mounts)
    gc.disable()
    try:
        search = Search(Engine(samples, model, judging_noise(samples).noise), ["joint_friction"], DEFAULT)
        trial = search.trials.of((Member(Known("joint_friction", ("5",))),))
        assert trial.forms[0] is not None and trial.forms[0].functions
        held = [weakref.ref(each) for each in (search, search.engine, search.engine.readings, search.trials.forms)]
        del search, trial
        assert [each() for each in held] == [None] * len(held)
    finally:
        gc.enable()
