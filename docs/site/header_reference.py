"""Reference of the C++ and the C interface, made of the headers' declarations and comments."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator
from pathlib import Path

from docs.site.headers import Declared, Header, read_header

HEADERS = Path("cpp/include/hexdbb")
ALIGNED = re.compile(r"^ |\S {2,}\S", flags=re.MULTILINE)
"""A paragraph whose columns or indentation mean something is shown as it stands."""
DIRECTIVES = {
    "cpp": {"function": "function", "variable": "var", "alias": "type", "enum": "enum", "enum-class": "enum-class"},
    "c": {"function": "function", "variable": "var", "macro": "macro", "enum": "enum"},
}
SHOWN_WHOLE = {"macro", "enum", "enum-class", "struct"}
"""What is told by its text in the header, where values and trailing comments stand in columns."""


def write_pages(root: Path, folder: Path) -> None:
    """Write the pages of all headers of the project, by language, and their indexes into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for domain, title, suffix in (("cpp", "C++", ".hpp"), ("c", "C", ".h")):
        names = sorted(path.name for path in (root / HEADERS).glob(f"*{suffix}"))
        (folder / domain).mkdir(exist_ok=True)
        for name in names:
            text = page(read_header(root / HEADERS / name), domain)
            (folder / domain / f"{_file(name)}.rst").write_text(text, encoding="utf-8")
        entries = "".join(f"   {domain}/{_file(name)}\n" for name in names)
        index = f"{title}\n{'=' * len(title)}\n\nThe public headers, one page each.\n\n.. toctree::\n\n{entries}"
        (folder / f"{domain}.rst").write_text(index, encoding="utf-8")


def page(header: Header, domain: str) -> str:
    """Return the page of a header in reStructuredText; domain `cpp` or `c`."""
    title = f"hexdbb/{header.name}"
    parts = [f"{title}\n{'=' * len(title)}", f".. highlight:: {domain}", prose(header.opening)]
    scope = ""
    for each in header.declared:
        if domain == "cpp" and each.scope != scope:
            scope = each.scope
            parts.append(f".. cpp:namespace:: {scope}")
        parts.extend(_described(each, domain))
    return "\n\n".join(part for part in parts if part) + "\n"


def prose(comment: str) -> str:
    """Return a comment in reStructuredText: paragraphs, what is aligned as it stands, code in backquotes."""
    paragraphs = re.split(r"\n\s*\n", comment.strip("\n"))
    return "\n\n".join(_paragraph(each) for each in paragraphs if each.strip())


def _paragraph(text: str) -> str:
    if ALIGNED.search(text):
        return ".. code-block:: none\n\n" + textwrap.indent(text, "   ")
    pieces = re.split(r"(`[^`]+`)", text)
    return "".join(each if each.startswith("`") else re.sub(r"([\\*|_])", r"\\\1", each) for each in pieces)


def _described(each: Declared, domain: str) -> Iterator[str]:
    directive = DIRECTIVES[domain].get(each.kind, each.kind)
    code = f".. code-block:: {domain}\n\n{textwrap.indent(each.text, '   ')}"
    if not each.signature[0] or (domain == "c" and each.kind == "alias"):
        yield from filter(None, (prose(each.comment), code))
        return
    lines = [f".. {domain}:{directive}:: " + "\n   ".join(each.signature)]
    within = [prose(each.comment)]
    if each.kind in SHOWN_WHOLE and not each.members:
        within.append(code)
    for member in each.members:
        within.extend(_described(member, domain))
    lines.extend(textwrap.indent(part, "   ") for part in within if part)
    yield "\n\n".join(lines)


def _file(name: str) -> str:
    return name.partition(".")[0]
