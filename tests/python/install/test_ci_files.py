"""The public forge's CI files call the scripts and targets there are, and do nothing that these do."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

ROOT = Path(__file__).parents[3]
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
TARGETS = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), flags=re.MULTILINE))
ALLOWED = (
    r"apt-get update && apt-get install --yes --no-install-recommends [a-z0-9 -]+",
    r"\.ci/run (?P<step>[a-z-]+)",
    r"make (?P<target>[a-z]+)",
    r"pipx run \"cibuildwheel==[0-9.*]+\" --output-dir dist",
)
"""A step is one call: what is done and how stands in `.ci`, the Makefile and pyproject.toml alone."""


def commands(workflow: Path) -> Iterator[str]:
    """Yield the commands of a workflow, one for each value of its matrix."""
    content: dict[str, Any] = yaml.safe_load(workflow.read_text(encoding="utf-8"))
    for job in content["jobs"].values():
        steps = job.get("strategy", {}).get("matrix", {}).get("step", [""])
        for each in job["steps"]:
            if "run" in each:
                yield from (each["run"].replace("${{ matrix.step }}", step) for step in steps)


def test_they_follow_the_published_schema() -> None:
    line = [
        sys.executable,
        "-m",
        "check_jsonschema",
        "--builtin-schema",
        "vendor.github-workflows",
        *map(str, WORKFLOWS),
    ]
    done = subprocess.run(line, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("workflow", WORKFLOWS, ids=lambda path: str(path.name))
def test_every_command_is_a_script_or_target_that_exists(workflow: Path) -> None:
    for command in commands(workflow):
        found = next(filter(None, (re.fullmatch(each, command) for each in ALLOWED)), None)
        assert found is not None, command
        assert set(found.groupdict().values()) <= TARGETS, command


def test_all_steps_of_the_local_run_are_there() -> None:
    local = re.search(
        r"^\[ \$# -gt 0 \] \|\| set -- (.*)$", (ROOT / ".ci/run").read_text(encoding="utf-8"), re.MULTILINE
    )
    assert local is not None
    called = {command.removeprefix(".ci/run ") for workflow in WORKFLOWS for command in commands(workflow)}
    assert set(local[1].split()) - {"setup"} <= called  # which every other one begins with
