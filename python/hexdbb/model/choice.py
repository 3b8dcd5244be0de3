"""Choosing values of a model by name: `leg_length`, `guideway_translation:3`, `leg_length:1:3:5`.

A choice is an effect's name, or a name and the elements meant, each after a colon; several choices are separated by
commas.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.learned.places import is_learned

Bools = NDArray[np.bool_]


@dataclass(frozen=True)
class Choice:
    """An effect, or some of its elements; no elements mean all."""

    effect: str
    elements: tuple[str, ...] = ()

    @classmethod
    def parse(cls, text: str) -> Choice:
        """Parse ``effect:element...``; whether there are such, `of_effect` checks."""
        if is_learned(text.strip()):  # a learned effect's name has its place and element in it
            return cls(text.strip())
        effect, *elements = text.strip().split(":")
        return cls(effect, tuple(elements))

    def __str__(self) -> str:
        return ":".join((self.effect, *self.elements))

    def of_effect(self, info: _core.EffectInfo) -> Bools:
        """Return which of the effect's values are chosen, shape (size of the effect,).

        Raises
        ------
        InputError
            An element that the effect does not have, with those it has.
        """
        for element in self.elements:
            if element not in info.elements:
                raise InputError(
                    f'{info.name}:{element}: {info.name} has no element "{element}"'
                    f" (expected one of {', '.join(info.elements)})"
                )
        meant = self.elements or tuple(info.elements)
        return np.array([element in meant for element in info.elements for _ in info.parameters], dtype=bool)
