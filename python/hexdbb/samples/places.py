"""What is fitted where the ball had several places on the platform within one fixing of the cup.

One offset of the ball then no longer absorbs a rotation of its holder, or of the platform's triangle of joints, which
none of the 33 errors is: it would look like joints off their places.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence

from hexdbb.model import Choice, Model, effect_names
from hexdbb.plan import places_of
from hexdbb.record import Record
from hexdbb.samples.fixings import mount_key
from hexdbb.samples.table import Samples


def with_set_up_of(samples: Samples, model: Model) -> Model:
    """Return a model that has the mounts of some samples, and what is fitted where the ball has several places."""
    return with_places_free(samples.records, model.with_mounts(samples.mounts))


def with_places_free(records: Sequence[Record], model: Model) -> Model:
    """Return a model whose effects of the ball's places are free too, where records have several in one fixing.

    A model that fits nothing of the set-up, or has these effects already, stays as it is.
    """
    balls = []
    for record in records:
        keys = {mount.id: mount_key(record, mount.id) for mount in record.mounts}
        balls += [(keys[each.mount], each.ball_offset_mm) for each in record.circles]
    return with_planned_places_free(balls, model)


def with_planned_places_free(balls: Iterable[tuple[Hashable, tuple[float, ...]]], model: Model) -> Model:
    """Return the same of a plan's circles, each given by its mount and the place of its ball."""
    parameters = model.parameters()
    fits_set_up = any(each.is_set_up and is_free for each, is_free in zip(parameters, model.free, strict=True))
    if not fits_set_up or all(count < 2 for count in places_of(balls).values()):
        return model
    for effect in effect_names("places"):
        if model.term(effect) is None:
            model = model.with_effect(Choice.parse(effect))
    return model
