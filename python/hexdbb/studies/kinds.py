"""The kinds of studies, by name: another study is another row, and a module that has it as `STUDY`."""

from __future__ import annotations

import importlib

from hexdbb.studies.study import Study

KINDS = {
    "power": "which sizes of which effects this plan finds on this machine, and how often it names a false one",
    "coverage": "whether 95 % intervals contain the truth in 95 % of the machines",
    "verdicts": "how often verdicts are right, on faults with forms of their own",
    "plan": "which circles determine most, searched over thousands of candidates",
    "tolerance": "how good gauge, repeatability and set-up must be",
}
"""What each answers; its module is imported when it is asked for."""
MODULES = {name: name for name in KINDS} | {"plan": "plan_search"}


def study_named(name: str) -> Study:
    """Return the study of a name, a key of `KINDS`."""
    study: Study = importlib.import_module(f"hexdbb.studies.{MODULES[name]}").STUDY
    return study
