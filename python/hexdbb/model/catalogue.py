"""Models from the catalogue: what an effect is on a machine, and a model with all values zero."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache, lru_cache
from types import MappingProxyType

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.kinematics import engine_machine
from hexdbb.machine import MachineFile
from hexdbb.model.own import OwnEffects


def effect_names(group: str = "") -> list[str]:
    """Return the names of the effects of a group (``geometry``, ``set-up``, ``places``, ``catalogue``), or of all."""
    return _core.effect_names(group)


@cache
def engine_effects() -> frozenset[str]:
    """Return the names of all effects of the engine."""
    return frozenset(effect_names())


def effect_info(machine: MachineFile, mounts: int, effect: str, own: OwnEffects | None = None) -> _core.EffectInfo:
    """Return the description of an effect; `own` are the user's.

    Raises
    ------
    InputError
        Where no effect has that name, with the names there are.
    """
    if own and effect in own:
        return own[effect].info()
    return effect_infos(machine, mounts, (effect,))[effect]


@lru_cache(maxsize=256)
def effect_infos(machine: MachineFile, mounts: int, effects: tuple[str, ...]) -> Mapping[str, _core.EffectInfo]:
    """Return the descriptions of some effects of the engine by name; asked for once, since nothing can change them.

    Raises
    ------
    InputError
        As `effect_info`.
    """
    engine = engine_machine(machine)
    try:
        return MappingProxyType({effect: _core.effect_info(engine, mounts, effect) for effect in effects})
    except ValueError as error:
        raise InputError(str(error)) from None


def default_effects(machine: MachineFile) -> dict[str, bool]:
    """Return the effects of a new model, and whether each is free (as its description states).

    They are the thesis' 33 geometric errors and the unknowns of the set-up: nobody knows where cup and ball sit to a
    micrometre. What is calibrated is held. Effects of the catalogue are added when something asks for them.
    """
    names = [*effect_names("geometry"), *effect_names("set-up")]
    return {name: effect_info(machine, 1, name).is_free_at_first for name in names}
