"""The documentation site: what its build refuses, and that its references leave nothing public out."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import pytest
from docs.site import command_reference, header_reference, python_reference, results_reference
from docs.site.headers import plain, read_header
from docs.site.links import broken_links
from docs.site.sections import pages_in_no_section, sections
from docs.site.staging import stage
from tests.documents.shown import blocks

import hexdbb
from hexdbb.cli import COMMANDS

ROOT = Path(__file__).parents[3]
INDEX = """\
# Documents

## Use

| page | for |
|---|---|
| [A](a.md) | all |
| [Kit](../firmware_interfaces/README.md) | all |
"""
HEADER = """\
// What it is.
//
//   a   b
#pragma once
namespace hexdbb {
/// Return one, with `code`.
int one(int a = 1);
int uno();

int two();  // after it
struct Data {
  double length_mm = 0.0;  // of a leg
};
class Worker {
 public:
  explicit Worker(int n) : n_(n) {}
  /// Compute.
  int work() const { return n_; }

 private:
  void hidden();
  int n_ = 0;
};
}  // namespace hexdbb
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """Write a project of two pages, one of them in another folder."""
    root = tmp_path / "project"
    for folder in ("docs/plans", "firmware_interfaces/sub"):
        (root / folder).mkdir(parents=True)
    for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md"):
        (root / name).write_text(f"# {name}\n")
    (root / "docs" / "README.md").write_text(INDEX)
    (root / "docs" / "plans" / "best.toml").write_text("x = 1\n")
    (root / "docs" / "a.md").write_text("# A\n[plan](plans/best.toml) [plans](plans) [web](https://a.example/b)\n")
    (root / "firmware_interfaces" / "README.md").write_text("# Kit\n[sub](sub/page.md)\n")
    (root / "firmware_interfaces" / "sub" / "page.md").write_text("# Sub\n[up](../README.md)\n")
    return root


def test_every_page_is_in_one_section() -> None:
    assert pages_in_no_section(ROOT) == []
    assert len(sections(ROOT)) >= 5


def test_page_in_no_section_ends_the_build(project: Path) -> None:
    (project / "docs" / "new.md").write_text("# New\n")
    with pytest.raises(ValueError, match=r"docs/new.md is in no section .*docs/README.md"):
        stage(project, project / "out")


@pytest.mark.parametrize(
    ("row", "fault"),
    [("| [B](b.md) | all |", "docs/b.md does not exist"), ("| [A](a.md) | again |", "docs/a.md stands in it 2 times")],
)
def test_faulty_index_is_refused(project: Path, row: str, fault: str) -> None:
    with (project / "docs" / "README.md").open("a") as index:
        index.write(f"{row}\n")
    with pytest.raises(ValueError, match=fault):
        sections(project)


def test_staged_pages_keep_what_they_link(project: Path, tmp_path: Path) -> None:
    stage(project, tmp_path / "out")
    page = (tmp_path / "out" / "docs" / "a.md").read_text()
    assert page == "# A\n[plan](plans/best.toml) plans [web](https://a.example/b)\n"
    assert (tmp_path / "out" / "docs" / "plans" / "best.toml").exists()
    assert "/firmware_interfaces/sub/page\n" in (tmp_path / "out" / "firmware_interfaces" / "README.md").read_text()
    start = (tmp_path / "out" / "index.md").read_text()
    assert ":caption: Use\n\n/docs/a\n/firmware_interfaces/README\n" in start


def test_header_is_read_with_its_comments(tmp_path: Path) -> None:
    path = tmp_path / "some.hpp"
    path.write_text(HEADER)
    header = read_header(path)
    assert header.opening == "What it is.\n\n  a   b"
    one, two, data, worker = header.declared
    assert (one.signature, one.comment) == (["int one(int a = 1)", "int uno()"], "Return one, with `code`.")
    assert (two.signature, two.comment, two.scope) == (["int two()"], "after it", "hexdbb")
    assert (data.kind, data.signature, data.members) == ("struct", ["Data"], [])
    assert [(each.signature, each.comment) for each in worker.members] == [
        (["explicit Worker(int n)"], ""),
        (["int work() const"], "Compute."),
    ]


def test_header_that_is_not_understood_is_named(tmp_path: Path) -> None:
    path = tmp_path / "some.hpp"
    path.write_text("#pragma once\nint one();\n)) class ((\n")
    with pytest.raises(ValueError, match=r"some.hpp:3: not understood"):
        read_header(path)


def test_comments_lose_their_markers_only() -> None:
    assert plain("/* One\n * two */") == "One\ntwo"
    assert plain("/// a * b\n///   c") == "a * b\n  c"


def test_c_reference_has_every_function_of_the_header(tmp_path: Path) -> None:
    header_reference.write_pages(ROOT, tmp_path)
    page = (tmp_path / "c" / "hexdbb.rst").read_text(encoding="utf-8")
    text = (ROOT / "cpp" / "include" / "hexdbb" / "hexdbb.h").read_text(encoding="utf-8")
    functions = set(re.findall(r"^[a-z].*?\b(hexdbb_\w+)\(", text, flags=re.MULTILINE))
    assert len(functions) > 10
    described = "\n".join(re.findall(r"^\.\. c:function:: (.*(?:\n   \S.*)*)", page, flags=re.MULTILINE))
    assert {name for name in functions if f"{name}(" not in described} == set()


def test_every_command_and_every_public_name_has_a_place(tmp_path: Path) -> None:
    command_reference.write_pages(tmp_path)
    assert {path.stem for path in (tmp_path / "cli").iterdir()} == {f"hexdbb-{each}" for each in (*COMMANDS, "run")}
    named = {name for names in python_reference.groups().values() for name in names}
    assert named == {name for name in hexdbb.__all__ if not name.startswith("_")}


def test_results_page_has_every_key_of_every_schema(tmp_path: Path) -> None:
    results_reference.write_page(tmp_path)
    page = (tmp_path / "results.md").read_text(encoding="utf-8")
    schemas = [json.loads(path.read_text(encoding="utf-8")) for path in results_reference.SCHEMAS.glob("*.json")]
    assert {each["$id"] for each in schemas} == set(re.findall(r"^`(hexdbb\.[\w.]+/\d+)`: ", page, flags=re.MULTILINE))
    assert [key for each in schemas for key in each["properties"] if f"| `{key}` | " not in page] == []
    assert "| any |" not in page


def test_examples_of_a_command_become_code() -> None:
    lines = ["Fit.", "", "| Examples:", "|   hexdbb diagnose a.parquet --json", ""]
    command_reference.show_examples_as_code(None, None, lines)
    shown = [line for line in lines if line]
    assert shown == ["Fit.", "Examples:", ".. code-block:: console", "   hexdbb diagnose a.parquet --json"]


def test_links_of_a_site_that_lead_nowhere_are_found(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    (tmp_path / "a.html").write_text('<p id="here"><a href="#here"></a><a href="sub/b.html#no"></a><img src="c.png">')
    (tmp_path / "sub" / "b.html").write_text('<a href="../a.html#here"></a><a href="https://a.example/no"></a>')
    assert broken_links(tmp_path) == ["a.html: sub/b.html#no", "a.html: c.png"]


def test_c_shown_compiles(tmp_path: Path) -> None:
    (shown,) = blocks(ROOT / "docs" / "how-to-embed.md", "c")
    include, _, body = shown.partition("\n")
    given = "#include <stddef.h>\nint refuse(const char*);\nvoid command(const double*);\n"
    path = tmp_path / "shown.c"
    path.write_text(f"{include}\n{given}int start(void) {{\n{body}\n  return 0;\n}}\n", encoding="utf-8")
    flags = ["-std=c11", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "-I", str(ROOT / "cpp" / "include")]
    subprocess.run(["gcc", *flags, str(path)], check=True)
