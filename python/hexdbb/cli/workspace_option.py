"""A workspace as an option: X,Y,Z,RADIUS[,HEIGHT[,TILT]]."""

from __future__ import annotations

from typing import Any

import click
from pydantic import ValidationError

from hexdbb.files.validation import EXPECTED
from hexdbb.machine import Workspace

KEYS = ("radius_mm", "height_mm", "tilt_deg")


class WorkspaceType(click.ParamType):
    """Reads a workspace; names what is wrong with it."""

    name = "X,Y,Z,RADIUS[,HEIGHT[,TILT]]"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Workspace:
        """Return the workspace of a text."""
        if isinstance(value, Workspace):
            return value
        try:
            numbers = [float(each) for each in str(value).split(",")]
        except ValueError:
            numbers = []
        if not 4 <= len(numbers) <= 6:
            self.fail(f"{value!r} (expected {self.name}: 4 to 6 numbers, mm and deg)", param, ctx)
        try:
            return Workspace.model_validate(
                {"centre_mm": tuple(numbers[:3]), **dict(zip(KEYS, numbers[3:], strict=False))}
            )
        except ValidationError as error:
            found = error.errors(include_url=False)[0]
            expected = EXPECTED.get(found["type"], found["msg"]).format(**found.get("ctx", {}))
            return self.fail(f"{found['loc'][0]}: {found['input']} (expected {expected})", param, ctx)
