"""Reference of the Python package: the names of `hexdbb`, in the groups of the table in its docstring."""

from __future__ import annotations

import inspect
import re
from pathlib import Path

import hexdbb

GROUP = re.compile(r"^(\S[^`]{0,20}?)  +(\S.*(?:\n {20,}.*)*)", flags=re.MULTILINE)
"""A row of the table: the name of a group, what is in it, further lines of it."""


def groups() -> dict[str, list[str]]:
    """Return the public names by group.

    Raises
    ------
    ValueError
        A name that `hexdbb` offers is in no row of the table.
    """
    assert hexdbb.__doc__ is not None
    table = re.split(r"^=+  =+$", hexdbb.__doc__, flags=re.MULTILINE)[1]
    offered = [name for name in dir(hexdbb) if not name.startswith("_")]
    found = {title: _names(text, offered) for title, text in GROUP.findall(table)}
    missing = sorted(set(offered) - {name for names in found.values() for name in names})
    if missing:
        raise ValueError(f"docstring of hexdbb: {missing[0]} is in no row of its table (expected: every public name)")
    return found


def write_pages(folder: Path) -> None:
    """Write the page of every group and their index into a folder."""
    (folder / "python").mkdir(parents=True, exist_ok=True)
    for title, names in groups().items():
        described = "\n".join(_directive(name) for name in names)
        page = f"{_heading(title)}\n.. currentmodule:: hexdbb\n\n{described}"
        (folder / "python" / f"{_file(title)}.rst").write_text(page, encoding="utf-8")
    entries = "".join(f"   python/{_file(title)}\n" for title in groups())
    index = f"Python\n======\n\n.. automodule:: hexdbb\n   :no-members:\n\n.. toctree::\n\n{entries}"
    (folder / "python.rst").write_text(index, encoding="utf-8")


def _names(text: str, offered: list[str]) -> list[str]:
    named = (each.partition(".")[0] for each in re.findall(r"`([\w.]+)[^`]*`", text))
    return [name for name in dict.fromkeys(named) if name in offered]


def _heading(title: str) -> str:
    title = title[0].upper() + title[1:]
    return f"{title}\n{'=' * len(title)}\n"


def _file(title: str) -> str:
    return title.replace(" ", "-")


def _directive(name: str) -> str:
    kind = "function"
    if inspect.isclass(value := getattr(hexdbb, name)):
        kind = "exception" if issubclass(value, Exception) else "class"
    members = "   :members:\n" if kind == "class" else ""
    return f".. auto{kind}:: {name}\n{members}\n"
