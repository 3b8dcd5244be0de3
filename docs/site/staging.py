"""Copy of the project's pages as the site reads them: Markdown as on a forge, navigation added, links kept.

The copy has the layout of the project, so that relative links hold. A file that a page links and that is no page is
copied for download; the link to a folder becomes plain text, since a site has no folders to look into.
"""

from __future__ import annotations

import re
import shutil
from pathlib import Path

from docs.site.sections import INDEX, Section, pages_in_no_section, sections

FOLDERS = ("docs", "firmware_interfaces")
PROJECT_PAGES = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md")
INTERFACES = ("cli", "results", "python", "cpp", "c")
"""Pages that the build writes, and that no forge has."""
IMAGES = (".png", ".svg")
FENCED = re.compile(r"^```.*?^```$", flags=re.MULTILINE | re.DOTALL)
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)#\s]+)(#[^)]*)?\)")


def stage(root: Path, into: Path) -> None:
    """Copy all pages of the project into a folder, with the start page and the navigation that the index gives.

    Raises
    ------
    ValueError
        A page of docs is in no section of the index, or the index is at fault.
    """
    listed = sections(root)
    if missing := pages_in_no_section(root):
        raise ValueError(f"{missing[0]} is in no section (enter it in the table of one section of {INDEX})")
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".md", *IMAGES):
                copy(path, root, into)
    for name in PROJECT_PAGES:
        copy(root / name, root, into)
    for page in sorted(into.rglob("*.md")):
        _adapt(page, root, into)
    (into / "index.md").write_text(start_page(listed), encoding="utf-8")


def copy(path: Path, root: Path, into: Path) -> None:
    """Copy a file to the same place below another folder."""
    target = into / path.relative_to(root)
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(path, target)


def start_page(listed: list[Section]) -> str:
    """Return the first page: what README says before its first section, and the navigation."""
    trees = [toctree(section.pages, section.title) for section in listed]
    trees.append(toctree(tuple(f"reference/{each}" for each in INTERFACES), "Interfaces"))
    trees.append(toctree((INDEX, *PROJECT_PAGES), "The project"))
    return '```{include} README.md\n:end-before: "## Try it"\n```\n\n' + "\n".join(trees)


def toctree(pages: tuple[str, ...], caption: str = "") -> str:
    """Return a directive that adds pages, named from the site's folder, to the navigation."""
    named = "\n".join(f"/{page.removesuffix('.md')}" for page in pages)
    title = f":caption: {caption}\n" if caption else ""
    return f"```{{toctree}}\n:hidden:\n{title}\n{named}\n```\n"


def _adapt(page: Path, root: Path, into: Path) -> None:
    """Replace links of a copied page that lead to no page, copy what they lead to, add the pages below an index."""
    text = page.read_text(encoding="utf-8")
    source = root / page.relative_to(into)

    def adapted(link: re.Match[str]) -> str:
        image, words, target, _ = link.groups()
        if "://" in target or image:
            return link[0]
        path = (source.parent / target).resolve()
        if path.is_dir():
            return words
        if path.suffix != ".md":
            copy(path, root, into)
        return link[0]

    parts = FENCED.split(text)
    fenced = FENCED.findall(text)
    text = "".join(LINK.sub(adapted, part) + block for part, block in zip(parts, [*fenced, ""], strict=True))
    name = page.relative_to(into).as_posix()
    if page.name == "README.md" and name not in (INDEX, "README.md"):
        below = [target for _, _, target, _ in LINK.findall(text) if target.endswith(".md") and ".." not in target]
        folder = page.relative_to(into).parent.as_posix()
        text += "\n" + toctree(tuple(f"{folder}/{target}" for target in dict.fromkeys(below)))
    page.write_text(text, encoding="utf-8")
