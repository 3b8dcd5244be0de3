"""Reference of the results that commands print with `--json`, made of the published schemas."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import hexdbb

SCHEMAS = Path(hexdbb.__file__).parent / "data" / "schemas"
LEAD = """\
# Results as JSON

What `--json` prints, key by key. The key `schema` names kind and version; programs should check it. The schemas
themselves are in the package, in `hexdbb/data/schemas`.
"""


def write_page(folder: Path) -> None:
    """Write the page of all schemas into a folder."""
    schemas = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(SCHEMAS.glob("*.schema.json"))]
    (folder / "results.md").write_text("\n".join([LEAD, *map(_section, schemas)]), encoding="utf-8")


def _section(schema: dict[str, Any]) -> str:
    parts = [f"## {schema['title']}\n", f"`{schema['$id']}`: {schema['description']}\n", _table(schema)]
    for name, each in schema.get("$defs", {}).items():
        if "properties" in each:
            parts += [f"### {name} of {schema['$id']}\n", f"{each.get('description', '')}\n", _table(each)]
    return "\n".join(parts)


def _table(schema: dict[str, Any]) -> str:
    rows = [f"| `{key}` | {_type(each)} | {_cell(each)} |" for key, each in schema.get("properties", {}).items()]
    return "\n".join(["| key | type | meaning |", "|---|---|---|", *rows]) + "\n"


def _cell(each: dict[str, Any]) -> str:
    return str(each.get("description", "")).replace("|", "\\|").replace("\n", " ")


def _type(each: dict[str, Any]) -> str:
    """Return the type of a value in words."""
    return " or ".join(dict.fromkeys(_types(each)))


def _types(each: dict[str, Any]) -> Iterator[str]:
    if "anyOf" in each:
        for one in each["anyOf"]:
            yield from _types(one)
    elif "$ref" in each:
        yield str(each["$ref"]).rpartition("/")[2]
    elif "const" in each or "enum" in each:
        yield ", ".join(f"`{value}`" for value in each.get("enum", [each.get("const")]))
    elif each.get("type") == "array" and "items" in each:
        yield f"list of {_type(each['items'])}"
    else:
        yield str(each.get("type", "any"))
