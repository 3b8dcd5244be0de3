"""A learned cause in words: what its function is, and what is said where geometry says most of it as well."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np

from hexdbb.discovery.words import function_clause
from hexdbb.learned import Learned, Space
from hexdbb.model import LearnedEffect, Term, new_term

NAME = "learned:leg:1-2:joint_angle"


def term(value_mm: float, sigma_mm: float, name: str = NAME) -> Term:
    space = Space(Learned.parse(name), -0.4, 0.4)
    effect = LearnedEffect(space, 1.0, 0.01)
    bands = (sigma_mm,) * (len(space.points()) * space.hypothesis.functions)
    found = new_term(name, effect.size)
    values = value_mm * np.linspace(-1.0, 1.0, effect.size)
    return replace(found, values=values, learned=replace(effect, sigma_mm=bands))


def test_a_cause_that_geometry_mostly_takes_is_not_said_to_be_nothing() -> None:
    """Two legs by the angle of their joints are two sliders nearer to each other: 65 µm either way."""
    clause = function_clause(term(0.01, 0.065))
    assert clause == "lengths of legs 1 and 2: follows the joint angle, by how much geometry tells as well"
    assert "distinguishable" not in clause


def test_one_that_stands_out_is_told_by_its_form() -> None:
    assert "µm" in function_clause(term(0.01, 0.0001))


def test_three_functions_that_make_up_for_one_another_are_one_clause() -> None:
    """Of a forked joint each varied by more than a millimetre, for a leg that errs by tens of micrometres."""
    clause = function_clause(term(1.0, 0.1, "learned:leg:3:leg_in_platform"))
    assert clause == "length of leg 3: follows the direction of the leg in the platform, otherwise at each of its tilts"


def test_of_many_curves_the_largest_is_told() -> None:
    """A load on the platform has six functions for each state: pulls and couples."""
    clause = function_clause(term(0.01, 0.0001, "learned:load:roll"))
    assert clause.startswith("load on the platform, by elastic legs, a ")
    assert re.search(r", and [2-5] smaller functions of it along other axes$", clause)
