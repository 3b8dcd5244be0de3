"""Published JSON Schemas (draft 2020-12) of what commands print with ``--json``; they lie in `data/schemas`.

Keys are stable: a later version may add some and takes none away. The schemas therefore allow keys they do not name.
"""

from __future__ import annotations

import json
from typing import Any

from hexdbb.errors import InputError
from hexdbb.machine import shipped

COMMANDS = ("diagnose", "compare", "discover", "add", "undo", "history")
"""Commands with a schema."""


def json_schema(command: str) -> dict[str, Any]:
    """Give the schema of what ``hexdbb COMMAND --json`` prints.

    Raises
    ------
    InputError
        A command that has none, with those that have one.
    """
    if command not in COMMANDS:
        raise InputError(f'no JSON schema of "{command}" (expected one of {", ".join(COMMANDS)})')
    schema: dict[str, Any] = json.loads(shipped("schemas", f"{command}.schema.json").read_text(encoding="utf-8"))
    return schema
