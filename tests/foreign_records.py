"""Records of simulators that share nothing with the project, and what is found in them, once in a process.

`tests/data/foreign`: standard circles, two feeds, both directions, 0.5 µm noise, random geometry, one fault each; and
of other simulators, on plans and with noise of their own, what once went wrong.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from hexdbb.discovery import Discovery, discover
from hexdbb.model import new_model
from hexdbb.record import read_record
from hexdbb.samples import Samples

FOREIGN = Path(__file__).parent / "data" / "foreign"


@lru_cache
def samples_of(name: str) -> Samples:
    return Samples.of([read_record(FOREIGN / f"{name}.parquet")])


@lru_cache
def found_in(name: str) -> Discovery:
    samples = samples_of(name)
    return discover(samples, new_model(samples.machine))
