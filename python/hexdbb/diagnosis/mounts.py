"""Set-ups a model does not know: where the cups of mounts stand, fitted with all else held."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hexdbb import _core
from hexdbb.diagnosis.fit import evaluate_fit
from hexdbb.diagnosis.noise import noise_of
from hexdbb.model import Model, MountKey, new_term
from hexdbb.samples import Samples
from hexdbb.units import readable_unit, shown_factor, shown_unit


def fit_mounts(samples: Samples, model: Model) -> tuple[Model, list[str]]:
    """Fit where the cups of mounts stand that a model does not know, holding all else: a set-up, not the machine.

    Records are fitted one after another, each at the noise of its own readings; those that share a fixing together.

    Returns
    -------
    model : Model
        Knowing the samples' mounts; the same object where it knew them.
    said : list of str
        What was found, one sentence for each mount.
    """
    said: list[str] = []
    for _, part in samples.of_each_record():
        places = [place for place in np.unique(part["mount"]) if samples.mounts[place] not in model.mounts]
        if places:
            part = samples.part(np.isin(samples["mount"], places))
            model, elements = _fitted(part, model, [samples.mounts[place] for place in places])
            said += [_sentence(_names(samples, key), model, element, key) for element, key in elements.items()]
    return model, said


def _names(samples: Samples, key: MountKey) -> str:
    """Return the records that have a mount."""
    numbers = np.unique(samples["record"][samples["mount"] == samples.mounts.index(key)])
    return ", ".join(samples.records[number].name for number in numbers)


def _fitted(samples: Samples, model: Model, unseen: list[MountKey]) -> tuple[Model, dict[str, MountKey]]:
    """Fit the values of some mounts; return the model and the elements that the mounts are."""
    known = _with_mount_effects(model).with_mounts(unseen)
    kinds = {term.effect: known.info(term.effect).element_kind for term in known.terms}
    places = {str(known.mounts.index(key) + 1): key for key in unseen}
    free = np.array([kinds[each.effect] == "mount" and each.element in places for each in known.parameters()])
    return evaluate_fit(samples, known, free, noise_of(samples))[0], places


def _with_mount_effects(model: Model) -> Model:
    infos = [model.info(name) for name in _core.effect_names()]
    missing = [info for info in infos if info.element_kind == "mount" and model.term(info.name) is None]
    return replace(model, terms=(*model.terms, *(new_term(info.name, 0) for info in missing)))


def _sentence(record: str, model: Model, element: str, key: MountKey) -> str:
    """State a mount's fitted values, effect by effect: cup and ball both have x, y and z."""
    values: dict[str, list[str]] = {}
    for parameter, value in zip(model.parameters(), model.values, strict=True):
        if model.info(parameter.effect).element_kind == "mount" and parameter.element == element:
            shown = f"{value * shown_factor(parameter.unit):+.1f} {readable_unit(shown_unit(parameter.unit))}"
            values.setdefault(parameter.effect, []).append(f"{parameter.name} {shown}")
    fitted = "; ".join(f"{effect} {', '.join(each)}" for effect, each in values.items())
    return f"{record}, mount {key.mount_id}: not known to the model, so its set-up was fitted first: {fitted}"
