"""Places of the ball on the platform: where one mount has several, its turn is fitted."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Sequence

from hexdbb.plan.circle import Circle
from hexdbb.plan.mount import Mount

Place = tuple[float, ...]


def places_of(balls: Iterable[tuple[Hashable, Place]]) -> dict[Hashable, int]:
    """Count the places of the ball within each mount.

    The 33 errors contain the sides of the platform's triangle of joints, not its orientation. With the ball at one
    place `ball_offset` absorbs the orientation, at several places it cannot.

    Parameters
    ----------
    balls : iterable of (hashable, tuple)
        Of each circle: what its mount is known by, and `ball_offset_mm`.
    """
    found: dict[Hashable, set[Place]] = {}
    for mount, place in balls:
        found.setdefault(mount, set()).add(tuple(place))
    return {mount: len(places) for mount, places in found.items()}


def ball_places_sentences(name: str, mounts: Sequence[Mount], circles: Sequence[Circle]) -> Iterator[str]:
    """Yield a sentence for each mount whose circles have the ball at several places of the platform.

    Parameters
    ----------
    name : str
        Of the plan.
    mounts : sequence of Mount
    circles : sequence of Circle
    """
    counts = places_of((each.mount, each.ball_offset_mm) for each in circles)
    for mount in mounts:
        if counts.get(mount.id, 0) > 1:
            yield (
                f"{name}: mount {mount.id} has its ball at {counts[mount.id]} places of the platform (ball_offset_mm): "
                "a rotation of the ball's holder, or of the triangle of joints, is fitted too (ball_rotation), since "
                "one ball offset does not hold it"
            )
