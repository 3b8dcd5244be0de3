"""Places of the ball on the platform: within one mount there should be one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hexdbb.plan.circle import Circle
from hexdbb.plan.mount import Mount


def ball_places_sentences(name: str, mounts: Sequence[Mount], circles: Sequence[Circle]) -> Iterator[str]:
    """Yield a sentence for each mount whose circles have the ball at several places of the platform.

    The 33 errors contain the sides of the platform's triangle of joints, not its orientation. With the ball at one
    place `ball_offset` absorbs the orientation, at several places it cannot.

    Parameters
    ----------
    name : str
        Of the plan or record.
    mounts : sequence of Mount
    circles : sequence of Circle
    """
    for mount in mounts:
        count = len({tuple(each.ball_offset_mm) for each in circles if each.mount == mount.id})
        if count > 1:
            yield (
                f"{name}: mount {mount.id} has its ball at {count} places of the platform (ball_offset_mm), but one "
                "fitted ball offset: a rotation of the ball's holder, or of the triangle of joints, then looks like "
                "joints off their places (expected a mount for each place)"
            )
