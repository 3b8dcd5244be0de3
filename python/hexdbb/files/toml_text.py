"""Plain content as TOML text, letter for letter as tomlkit writes it, in a twentieth of the time.

tomlkit makes an object of every value, so that a file can be edited and keeps its comments: a model takes it 20 ms, and
its import as long. Content hashes and files in use rely on its form. What is rare, and where its form has exceptions,
is left to it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
PLAIN_TEXT = re.compile(r'[^"\\\x00-\x1f\x7f]*')
"""Texts that stand in quotes as they are."""


class _UnusualError(Exception):
    """Raised for content whose form is left to tomlkit."""


def toml_text(content: Mapping[str, Any]) -> str:
    """Return content as TOML text.

    Parameters
    ----------
    content : mapping
        Of numbers, texts, truth values, lists and tables of them.
    """
    try:
        return "\n\n".join(_blocks((), content)) + "\n"
    except _UnusualError:
        import tomlkit  # takes as long to import as to write a model

        return tomlkit.dumps(content)


def _blocks(path: tuple[str, ...], table: Mapping[str, Any], heading: str = "") -> Iterator[str]:
    """Yield a table's own values under its heading, then the tables within it."""
    values = [f"{_key(name)} = {_value(each)}" for name, each in table.items() if not _is_table(each)]
    tables = {name: each for name, each in table.items() if _is_table(each)}
    is_list = heading.startswith("[[")
    if (
        (not table or (is_list and not values))
        or (values and next(iter(table)) in tables)
        or (path and len({type(each) is dict for each in tables.values()}) > 1)
    ):
        raise _UnusualError
    if values:
        yield "\n".join([heading, *values] if heading else values)
    for name, each in tables.items():
        inner = (*path, _key(name))
        named = ".".join(inner)
        if type(each) is dict:
            yield from _blocks(inner, each, f"[{named}]")
        else:
            for element in each:
                yield from _blocks(inner, element, f"[[{named}]]")


def _is_table(value: Any) -> bool:
    return type(value) is dict or (
        type(value) in (list, tuple) and len(value) > 0 and all(type(each) is dict for each in value)
    )


def _key(name: Any) -> str:
    if type(name) is not str or BARE_KEY.fullmatch(name) is None:
        raise _UnusualError
    return name


def _value(value: Any) -> str:
    kind = type(value)
    if kind is float or kind is int:
        return str(value)
    if kind is bool:
        return "true" if value else "false"
    if kind is str and PLAIN_TEXT.fullmatch(value):
        return f'"{value}"'
    if kind is list or kind is tuple:
        return f"[{', '.join(map(_value, value))}]"
    raise _UnusualError
