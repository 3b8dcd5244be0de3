"""A workspace as an option: X,Y,Z,RADIUS[,HEIGHT[,TILT]]."""

from __future__ import annotations

import click
from pydantic import ValidationError

from hexdbb.files.validation import EXPECTED
from hexdbb.machine import Workspace

FORM = "X,Y,Z,RADIUS[,HEIGHT[,TILT]]"
KEYS = ("radius_mm", "height_mm", "tilt_deg")


def workspace_of(text: str) -> Workspace:
    """Return the workspace of a text, mm and deg; `click.BadParameter` names what is wrong with it."""
    try:
        numbers = [float(each) for each in text.split(",")]
    except ValueError:
        numbers = []
    if not 4 <= len(numbers) <= 3 + len(KEYS):
        raise click.BadParameter(f"{text!r} (expected {FORM}: 4 to 6 numbers, mm and deg)")
    try:
        return Workspace.model_validate({"centre_mm": tuple(numbers[:3]), **dict(zip(KEYS, numbers[3:], strict=False))})
    except ValidationError as error:
        found = error.errors(include_url=False)[0]
        expected = EXPECTED.get(found["type"], found["msg"]).format(**found.get("ctx", {}))
        raise click.BadParameter(f"{found['loc'][0]}: {found['input']} (expected {expected})") from None


def workspace_text(space: Workspace) -> str:
    """Return the text of a workspace."""
    return ",".join(f"{each:g}" for each in (*space.centre_mm, space.radius_mm, space.height_mm, space.tilt_deg))
