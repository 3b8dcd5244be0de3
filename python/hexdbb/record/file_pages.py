"""Key tables of the documentation pages on files, generated from the models that validate the files.

A page holds each table between two marker lines; `updated` replaces what stands between them. The meaning of a key is
the docstring of its field, its type and limits are those of the model's JSON schema. To rewrite the committed pages:
``python -m hexdbb.record.file_pages docs``.
"""

from __future__ import annotations

import ast
import inspect
import json
import sys
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from hexdbb.machine import MachineFile
from hexdbb.plan import Plan
from hexdbb.record.measurement import Measurement

PAGES: dict[str, type[BaseModel]] = {
    "machine-file.md": MachineFile,
    "plan-file.md": Plan,
    "text-form.md": Measurement,
}
"""Pages that hold key tables, and the model of the file that each describes."""
BEGIN = "<!-- keys: made by `python -m hexdbb.record.file_pages docs`; do not edit -->"
END = "<!-- end of keys -->"

Schema = dict[str, Any]


def key_tables(model: type[BaseModel]) -> str:
    """Return the Markdown tables of a file's keys: the root first, then each section in the order of the file."""
    whole = model.model_json_schema(by_alias=True)
    definitions = whole.get("$defs", {})
    blocks = []
    for heading, section, schema in _sections("", model, whole, definitions):
        meanings = _meanings(section)
        rows = [
            f"| `{key}` | {_type_words(each, definitions)} | {_default_words(key, each, schema)} | {meanings[key]} |"
            for key, each in schema["properties"].items()
        ]
        title = f"### `{heading}`\n\n" if heading else ""
        blocks.append(title + "\n".join(["| key | value | default | meaning |", "|---|---|---|---|", *rows]))
    return "\n\n".join(blocks)


def updated(page: str, model: type[BaseModel]) -> str:
    """Return a page's text with the key tables of a file generated anew; `ValueError` as in `replaced`."""
    return replaced(page, BEGIN, END, key_tables(model))


def replaced(page: str, begin: str, end: str, text: str) -> str:
    """Return a page with a text in place of what stands between two marker lines.

    Raises
    ------
    ValueError
        The page does not hold both markers once.
    """
    if page.count(begin) != 1 or page.count(end) != 1:
        raise ValueError(f"a page needs the lines {begin} and {end} once each")
    before, _, rest = page.partition(begin)
    return f"{before}{begin}\n{text}\n{end}{rest.partition(end)[2]}"


def _sections(
    heading: str, model: type[BaseModel], schema: Schema, definitions: Schema
) -> Iterator[tuple[str, type[BaseModel], Schema]]:
    """Yield heading, model and schema of a model and of all models below it, depth first."""
    yield heading, model, schema
    path = heading.strip("[]")
    for name, field in model.model_fields.items():
        key = field.alias or name
        below = _resolved(schema["properties"][key], definitions)
        repeated = below.get("type") == "array"
        item = _resolved(below["items"], definitions) if repeated and "items" in below else below
        if "properties" in item:
            inner = f"{path}.{key}".lstrip(".")
            yield from _sections(
                f"[[{inner}]]" if repeated else f"[{inner}]", _model_in(field.annotation), item, definitions
            )


def _model_in(annotation: object) -> type[BaseModel]:
    """Return the one model named in an annotation such as ``tuple[Circle, ...]`` or ``CanSetup | None``."""
    pending = [annotation]
    while pending:
        each = pending.pop()
        if inspect.isclass(each) and issubclass(each, BaseModel):
            return each
        pending += getattr(each, "__args__", ())
    raise TypeError(f"no model in {annotation}")


def _meanings(model: type[BaseModel]) -> dict[str, str]:
    """Return the docstring of each field by its key, on one line."""
    (body,) = ast.parse(textwrap.dedent(inspect.getsource(model))).body
    assert isinstance(body, ast.ClassDef)
    found = {}
    for statement, following in zip(body.body, body.body[1:], strict=False):
        if isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name):
            name = statement.target.id
            if name in model.model_fields and isinstance(following, ast.Expr):
                text = ast.literal_eval(following.value)
                found[model.model_fields[name].alias or name] = " ".join(text.split())
    return found


def _resolved(schema: Schema, definitions: Schema) -> Schema:
    """Return a schema with its reference followed and the alternative `null` removed."""
    alternatives = [each for each in schema.get("anyOf", []) if each.get("type") != "null"]
    if len(alternatives) == 1:
        schema = alternatives[0]
    if "$ref" in schema:
        schema = definitions[schema["$ref"].rpartition("/")[2]]
    return schema


def _type_words(schema: Schema, definitions: Schema) -> str:
    schema = _resolved(schema, definitions)
    if "oneOf" in schema:
        return "; or ".join(_type_words(each, definitions) for each in schema["oneOf"])
    if "const" in schema:
        return f"`{json.dumps(schema['const'])}`"
    if "enum" in schema:
        return " or ".join(f"{each}" for each in schema["enum"])
    if "properties" in schema or schema.get("type") == "object":
        return "table"
    if schema["type"] == "array":
        if "prefixItems" in schema:
            return f"list of {len(schema['prefixItems'])}: {_type_words(schema['prefixItems'][0], definitions)}"
        item = _type_words(schema["items"], definitions)
        return "tables" if item == "table" else f"list of at least {schema.get('minItems', 0)}: {item}"
    if schema.get("format") == "date":
        return "date, as `2026-03-01`"
    name = {"number": "number", "integer": "whole number", "string": "text", "boolean": "true or false"}[schema["type"]]
    limits = [
        f"{sign} {schema[key]:g}" if isinstance(schema[key], float) else f"{sign} {schema[key]}"
        for key, sign in (("exclusiveMinimum", ">"), ("minimum", "≥"), ("exclusiveMaximum", "<"), ("maximum", "≤"))
        if key in schema
    ]
    if schema.get("minLength"):
        limits.append("not empty")
    return ", ".join([name, *limits])


def _default_words(key: str, schema: Schema, of: Schema) -> str:
    """Return the default of a key; the key `schema` has one in memory, and must be given in a file."""
    if key in of.get("required", ()) or "const" in schema:
        return "required"
    default = schema.get("default")
    if default is None and "$ref" in schema:  # made anew for each file
        return "as below"
    if default is None or default == {}:
        return "none"
    if isinstance(default, dict):
        return "as below"
    if isinstance(default, list) and len(set(map(str, default))) == 1 and isinstance(default[0], str):
        default = default[0]
    return f"`{json.dumps(default)}`"


def main(folder: Path) -> None:
    """Rewrite the key tables of the pages in a folder."""
    for name, model in PAGES.items():
        page = folder / name
        page.write_text(updated(page.read_text(encoding="utf-8"), model), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
