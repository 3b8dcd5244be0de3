"""Places of the ball on the platform: within one mount there should be one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hexdbb.plan.circle import Circle
from hexdbb.plan.mount import Mount


def ball_places_sentences(name: str, mounts: Sequence[Mount], circles: Sequence[Circle]) -> Iterator[str]:
    """Yield a sentence for each mount whose circles have the ball at several places of the platform.

    The 33 errors have the sides of the platform's triangle of joints, not how it is turned: with the ball at one place
    `ball_offset` takes that, at several it does not.

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
                f"{name}: mount {mount.id} has its ball at {count} places of the platform (ball_offset_mm), with one "
                "error of place for all: what turns them together, as a holder or the triangle of joints may be "
                "turned, reads like joints off their places (expected a mount for each place)"
            )
