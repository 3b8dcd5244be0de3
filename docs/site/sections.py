"""Sections of the documentation: the headings and tables of docs/README.md, the one place where a page is entered.

The index is read as it stands on a forge: every `##` heading is a section, every link in the first column of its table
a page. The site's navigation is made of it, so that a page stands in one list only.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

INDEX = "docs/README.md"
HEADING = re.compile(r"^## (.+)$", flags=re.MULTILINE)
ENTRY = re.compile(r"^\| \[[^\]]+\]\(([^)#]+\.md)\) \|", flags=re.MULTILINE)


@dataclass(frozen=True)
class Section:
    """A heading of the index and its pages, as paths from the project's folder."""

    title: str
    pages: tuple[str, ...]


def sections(root: Path) -> list[Section]:
    """Return the sections of the index in their order.

    Raises
    ------
    ValueError
        A section has no page, a page does not exist, or it stands in two places.
    """
    _, *parts = HEADING.split((root / INDEX).read_text(encoding="utf-8"))
    found = [
        Section(title, tuple(_from_root(link) for link in ENTRY.findall(text)))
        for title, text in zip(parts[::2], parts[1::2], strict=True)
    ]
    listed = [page for section in found for page in section.pages]
    faults = [f"section '{section.title}' has no page" for section in found if not section.pages]
    faults += [f"{page} does not exist" for page in listed if not (root / page).exists()]
    faults += [f"{page} stands in it {listed.count(page)} times" for page in set(listed) if listed.count(page) > 1]
    if faults:
        raise ValueError(f"{INDEX}: {faults[0]} (expected: every page once, in the table of a section)")
    return found


def pages_in_no_section(root: Path) -> list[str]:
    """Return the pages of docs that the index does not list.

    Pages of a folder below docs that has an index of its own (README.md) belong to that index.
    """
    listed = {page for section in sections(root) for page in section.pages} | {INDEX}
    pages = [path.relative_to(root) for path in sorted((root / "docs").rglob("*.md"))]
    return [str(page) for page in pages if str(page) not in listed and not _has_own_index(root, page)]


def _has_own_index(root: Path, page: Path) -> bool:
    return page.parent != Path("docs") and page.name != "README.md" and (root / page.parent / "README.md").exists()


def _from_root(link: str) -> str:
    """Return the path from the project's folder of a link of the index."""
    parts: list[str] = []
    for part in (PurePosixPath(INDEX).parent / link).parts:
        if part == "..":
            parts.pop()
        else:
            parts.append(part)
    return "/".join(parts)
