"""Pages hang together: links lead somewhere, the index lists every page, commands shown exist."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from tests.documents.shown import blocks

from hexdbb.cli import cli
from hexdbb.effects import load_effects

ROOT = Path(__file__).parents[3]
FOLDERS = ("firmware_interfaces", "docs")
PAGES = [ROOT / "README.md", *(page for folder in FOLDERS for page in sorted((ROOT / folder).rglob("*.md")))]

LINKING = [*PAGES, ROOT / "CHANGELOG.md", ROOT / "CONTRIBUTING.md"]


@pytest.mark.parametrize("page", LINKING, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page: Path) -> None:
    targets = re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8"))
    local = [target for target in targets if "://" not in target]
    assert [target for target in local if not (page.parent / target).exists()] == []


@pytest.mark.parametrize("page", LINKING, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_to_headings_lead_to_one(page: Path) -> None:
    links = re.findall(r"\]\(([^)#\s]*\.md|)#([^)]+)\)", page.read_text(encoding="utf-8"))
    missing = [(name, anchor) for name, anchor in links if anchor not in anchors(page.parent / name if name else page)]
    assert missing == []


def anchors(page: Path) -> set[str]:
    """Return the anchors that a forge gives to the headings of a page."""
    text = re.sub(r"^```.*?^```$", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    headings = [
        re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", each) for each in re.findall(r"^#+ (.+)$", text, flags=re.MULTILINE)
    ]
    return {re.sub(r"[^\w\- ]", "", each.lower()).replace(" ", "-") for each in headings}


INDEXES = [page for page in PAGES if page.name == "README.md" and page.is_relative_to(ROOT / "docs")]


@pytest.mark.parametrize("index", INDEXES, ids=lambda page: str(page.relative_to(ROOT)))
def test_index_lists_every_page_of_its_folder_and_the_indexes_below(index: Path) -> None:
    linked = set(re.findall(r"\]\(([^)]+\.md)\)", index.read_text(encoding="utf-8")))
    below = {str(page.relative_to(index.parent)) for page in PAGES if page.is_relative_to(index.parent)}
    pages = {page for page in below if "/" not in page or Path(page).name == "README.md"}
    assert pages - linked == {"README.md"}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_commands_shown_exist(page: Path) -> None:
    shown = set(re.findall(r"^(?:\$ )?hexdbb ([a-z][a-z-]*)", "\n".join(blocks(page)), flags=re.MULTILINE))
    shown |= set(re.findall(r"`hexdbb ([a-z][a-z-]*)", page.read_text(encoding="utf-8")))
    assert shown - set(cli.list_commands(None)) == set()


def test_architecture_names_every_part_of_the_package() -> None:
    named = set(re.findall(r"`([a-z_0-9]+)`", (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")))
    package = ROOT / "python" / "hexdbb"
    modules = {path.stem for path in package.glob("*.py") if path.stem != "__init__"}
    packages = {path.parent.name for path in package.glob("*/__init__.py")}
    assert (modules | packages) - named == set()


def test_discovery_page_shows_a_whole_file_of_effects(tmp_path: Path) -> None:
    (shown,) = blocks(ROOT / "docs" / "discovery.md", "python")
    (tmp_path / "mine.py").write_text(shown, encoding="utf-8")
    assert [each.name for each in load_effects(tmp_path / "mine.py")] == ["dent"]
