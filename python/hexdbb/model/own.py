"""Effects of a user's own in a model: declared by a file the user names; the model's file keeps name and values.

What such an effect does comes from the samples themselves, so the engine's form of a model that has one is made for the
samples it is to predict. Nothing in a model file causes code to run: a file that names such an effect is refused until
the user names the file that declares it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from hexdbb import _core
from hexdbb.machine import MachineFile


class OwnEffect(Protocol):
    """What a model asks of a user's effect (`hexdbb.effects.UserEffect`)."""

    @property
    def name(self) -> str:
        """Name, as in the model file."""
        ...

    def info(self) -> _core.EffectInfo:
        """Describe it as the engine's own are described."""
        ...

    def add_to(self, engine: _core.Model, samples: _core.Samples, machine: MachineFile) -> None:
        """Append it, values zero, to a model that is to predict these samples, or a part of them."""
        ...


OwnEffects = Mapping[str, OwnEffect]
"""Users' effects by name."""
