"""`hexdbb study` as a program: what it writes, and one line for each bad input, with nothing written."""

from __future__ import annotations

from pathlib import Path

import pyarrow.parquet as pq
import pytest
from tests.programs import called

from hexdbb.machine import shipped
from hexdbb.plan import load_plan

STUDY = """\
schema = "hexdbb.study/1"
plan = "{plan}"
feeds_mm_min = [3000.0]
rate_hz = 10.0
cases = 2

[plan_search]
circles = [3]
"""


def test_the_command_writes_cases_picture_page_and_plan(tmp_path: Path) -> None:
    """A plan and a machine of one's own, beside the study file; the plan found refers to the machine where it lies."""
    beside = tmp_path / "mine"
    beside.mkdir()
    (beside / "machine.toml").write_text(shipped("sp120.toml").read_text(encoding="utf-8"), encoding="utf-8")
    plan = shipped("plans", "standard.toml").read_text(encoding="utf-8")
    (beside / "plan.toml").write_text(plan.replace('"sp120"', '"machine.toml"'), encoding="utf-8")
    (beside / "study.toml").write_text(STUDY.format(plan="plan.toml"), encoding="utf-8")
    line = "study plan mine/study.toml --workers 1 -o found/cases --page page.md"
    done = called("hexdbb", *line.split(), folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "3 circles: " in done.stdout
    assert "2 done in " in done.stderr
    files = {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*") if path.suffix in (".md", ".png")}
    assert files == {"page.md", "images/page.png"}
    rows = pq.read_table(tmp_path / "found" / "cases").to_pylist()
    assert sorted(row["case"] for row in rows) == [0, 1]
    page = (tmp_path / "page.md").read_text(encoding="utf-8")
    assert "![Which circles determine most?](images/page.png)" in page
    assert f"Made by `hexdbb {line}`." in page
    found = load_plan(tmp_path / "found" / "cases-3-circles.toml")
    assert found.machine == "../mine/machine.toml"
    assert found.machine_file().name == "SP-120 (assumed dimensions)"
    again = called("hexdbb", *line.split(), folder=tmp_path)
    assert "2 of 2 were done before: nothing to do" in again.stderr
    assert again.stdout == done.stdout


FAR = ("radius_mm = 100.0", "radius_mm = 290.0"), ("bar_length_mm = 100.0", "bar_length_mm = 290.0")


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("study power unknown.toml", "unknown.toml: case: unknown key (expected cases)"),
        ("study power zero.toml", "zero.toml: cases: 0 (expected a number >= 1)"),
        ("study coverage -n 0", "options: cases: 0 (expected a number >= 1)"),
        ("study power --effect gremlin", 'options: power.effects[0]: "gremlin" (expected one of backlash, '),
        (
            "study coverage --plan far.toml",
            "far.toml: circle 0 is out of reach of SP-120 (assumed dimensions) (exp",
        ),
        ("study coverage nothing.toml", "nothing.toml: no such file (expected a study file, or a shipped study: stand"),
        ("study coverage --picture a.jpg", "--picture a.jpg: no PNG (expected a name that ends in .png)"),
        ("study coverage --page far/page.md", "far/page.md: no such directory far (expected one that exists)"),
        ("study verdicts --lines zero.toml", "zero.toml: line 1: not a result (expected a JSON object with a case)"),
        ("study tolerance --target 0", "options: tolerance.target_um: 0 (expected a number > 0)"),
        ("study coverage -o .", ".: holds other files, as "),
    ],
)
def test_bad_input_is_one_line_and_nothing_is_written(line: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "unknown.toml").write_text('schema = "hexdbb.study/1"\ncase = 10\n', encoding="utf-8")
    (tmp_path / "zero.toml").write_text('schema = "hexdbb.study/1"\ncases = 0\n', encoding="utf-8")
    far = shipped("plans", "thesis.toml").read_text(encoding="utf-8")
    for old, new in FAR:
        assert old in far
        far = far.replace(old, new)
    (tmp_path / "far.toml").write_text(far, encoding="utf-8")
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    done = called("hexdbb", *line.split(), folder=tmp_path)
    assert done.returncode == 2
    assert done.stdout == ""
    (error,) = [each for each in done.stderr.splitlines() if each.startswith("error: ")]
    assert said in error
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_result_lines_are_reported_without_a_run(tmp_path: Path) -> None:
    lines = [
        '{"case": "none-judge-s1", "withheld": [], "hidden": [], "grade": "none", "found": [], "seconds": 1.0,'
        ' "outcome": "right", "after_adding": "", "heldout": {}, "claimed": []}',
        '{"case": "none-judge-s2", "withheld": [], "hidden": [], "grade": "effect", "found": [{"name": "backlash:1"}],'
        ' "seconds": 2.0, "outcome": "false", "after_adding": "", "heldout": {}, "claimed": []}',
        '{"case": "backlash-d0-x100-judge-s1", "withheld": [], "unreachable": "beyond"}',
    ]
    (tmp_path / "lines.jsonl").write_text("\n".join(lines), encoding="utf-8")
    done = called("hexdbb", "study", "verdicts", "--lines", "lines.jsonl", "--page", "page.md", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "2 cases: right 50 % (1 to 99 %), a false name 50.0 % (1.3 to 98.7 %); 1 left out" in done.stdout
    page = (tmp_path / "page.md").read_text(encoding="utf-8")
    assert "| clean machine: `none` | ≥ 99 % | 50.0 % of 2 (9 to 91 %) |" in page
    assert "2 cases of the judge half; 0 failed to run." in page
