"""Declared results: a frozen dataclass says what a command's JSON holds; the object and its schema follow from it.

A key is a field, its description the string below the field, its limits an annotation::

    @dataclass(frozen=True)
    class ComparisonJson(JsonResult):
        SCHEMA = "hexdbb.compare/1"

        rms_um: NotNegative
        \"\"\"Root mean square residual of all samples.\"\"\"
        circles: tuple[CircleJson, ...]   # CircleJson is a JsonPart: an object inside, without a SCHEMA

    ComparisonJson(...).to_json()         # {"schema": "hexdbb.compare/1", "rms_um": ..., "circles": [...]}
    ComparisonJson.json_schema()          # draft 2020-12, as published

What is not known is `None` (null), never nan, which JSON has not. Types must be importable where the class stands, not
under `TYPE_CHECKING` alone: they are read when the program runs.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar

from pydantic import ConfigDict, Field, TypeAdapter

DRAFT = "https://json-schema.org/draft/2020-12/schema"

NotNegative = Annotated[float, Field(ge=0.0)]
Share = Annotated[float, Field(ge=0.0, le=1.0)]
Count = Annotated[int, Field(ge=0)]

_ADAPTERS: dict[type, TypeAdapter[Any]] = {}


class JsonPart:
    """Base of dataclasses that are objects inside a result."""

    __pydantic_config__: ClassVar[ConfigDict] = ConfigDict(use_attribute_docstrings=True)


class JsonResult(JsonPart):
    """Base of dataclasses that are what a command prints with ``--json``.

    Attributes
    ----------
    SCHEMA : str
        ``hexdbb.COMMAND/N``. N rises when a key is taken away or changes its meaning; new keys leave it.
    """

    SCHEMA: ClassVar[str]

    def to_json(self) -> dict[str, Any]:
        """Return the object with its schema's id: dicts, lists, strings, finite numbers and None."""
        return {"schema": self.SCHEMA, **_adapter(type(self)).dump_python(self, mode="json")}

    @classmethod
    def json_schema(cls) -> dict[str, Any]:
        """Return the JSON Schema (draft 2020-12) of what `to_json` returns; it allows keys that it does not name."""
        schema = _without_titles(_adapter(cls).json_schema(mode="serialization"))
        command = cls.SCHEMA.partition("/")[0].replace(".", " ")
        head = {"$schema": DRAFT, "$id": cls.SCHEMA, "title": f"{command} --json"}
        schema["required"] = ["schema", *schema["required"]]
        schema["properties"] = {
            "schema": {"const": cls.SCHEMA, "description": "What this object is, and in which version."},
            **schema["properties"],
        }
        return {**head, **schema}


def number_or_none(value: float) -> float | None:
    """Return a number, or None where it is not known (nan)."""
    return None if math.isnan(value) else float(value)


def _adapter(kind: type[JsonResult]) -> TypeAdapter[Any]:
    """Return the type's adapter, which takes some milliseconds to make."""
    if kind not in _ADAPTERS:
        _ADAPTERS[kind] = TypeAdapter(kind)
    return _ADAPTERS[kind]


def _without_titles(schema: Any) -> Any:
    """Return the schema without the titles pydantic makes of names: they say nothing that the names do not."""
    if isinstance(schema, dict):
        return {
            key: {name: _without_titles(each) for name, each in value.items()}
            if key in {"properties", "$defs"}
            else _without_titles(value)
            for key, value in schema.items()
            if key != "title"
        }
    return [_without_titles(each) for each in schema] if isinstance(schema, list) else schema
