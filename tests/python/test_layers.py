"""Who may import whom: the directions of docs/architecture.md, read from the sources' own import statements.

The lines machine -> ... -> report and rig -> capture -> record meet in the commands only. The simulated rig holds the
truth that predictions are judged by and shares no code path with them; the C++ engine knows neither Python nor, outside
the diagnosis, Ceres.
"""

from __future__ import annotations

import ast
import re
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "python" / "hexdbb"

# Each part of the package (a module, or a package with all that is in it) and the parts it may import. What is imported
# through others counts where it is written: `rig` may use `machine` and thereby, not itself, `can_setup`.
ALLOWED: dict[str, set[str]] = {
    "errors": set(),
    "units": set(),
    "_core": set(),
    "atomic_file": {"errors"},
    "validation": {"errors"},
    "circle_fit": {"errors"},
    "frames": {"errors"},
    "json_schemas": {"errors", "machine"},
    "can_setup": {"errors", "validation"},
    "circle": {"errors", "validation", "kinematics"},
    "machine": {"errors", "validation", "can_setup"},
    "plan": {"errors", "validation", "machine", "circle"},
    "record": {"errors", "validation", "atomic_file", "machine", "circle", "plan"},
    # the machine's line
    "kinematics": {"errors", "machine", "_core"},
    "model": {"errors", "validation", "atomic_file", "units", "machine", "kinematics", "_core"},
    "effects": {"errors", "units", "machine", "plan", "kinematics", "model", "state", "_core"},
    "structure": {"model"},
    "redundancy": {"model", "structure"},
    "thermometer": set(),
    "state": {"plan", "record", "thermometer"},
    "prediction": {"errors", "record", "kinematics", "model", "state", "_core"},
    "measured": {"record", "model", "prediction", "_core"},
    "diagnosis": {
        "errors",
        "frames",
        "units",
        "circle",
        "record",
        "model",
        "prediction",
        "measured",
        "redundancy",
        "_core",
    },
    "ledger": {"errors", "frames", "units", "record", "model", "prediction", "diagnosis", "_core"},
    "place_uncertainty": {"circle", "kinematics", "model", "diagnosis", "_core"},
    # which variable of the samples carries a residual
    "variables": {"record", "model", "effects", "_core"},
    "discovery": {
        "errors",
        "units",
        "circle",
        "record",
        "kinematics",
        "model",
        "effects",
        "prediction",
        "measured",
        "diagnosis",
        "ledger",
        "variables",
        "_core",
    },
    # what a controller does about it
    "compensation": {"errors", "atomic_file", "machine", "record", "kinematics", "model", "_core"},
    "compensated_targets": {"can_setup", "kinematics", "trajectory", "_core"},
    "sensitivity": {"errors", "kinematics", "model", "plan", "prediction", "state", "record", "_core"},
    "identifiability": {"model", "redundancy", "sensitivity", "_core"},
    # which circles tell most
    "planning": {
        "errors",
        "units",
        "machine",
        "circle",
        "plan",
        "kinematics",
        "identifiability",
        "model",
        "redundancy",
        "sensitivity",
        "trajectory",
        "_core",
    },
    # where the model fails; readings come in as arrays, predicted or measured
    "iso230": {"errors", "circle_fit"},
    "compare": {"errors", "frames", "record", "circle", "iso230", "variables"},
    "plots": {"errors", "atomic_file", "circle", "iso230", "compare", "variables"},
    # the thesis' own way, to hold beside it
    "thesis": {
        "errors",
        "units",
        "atomic_file",
        "machine",
        "circle",
        "plan",
        "record",
        "kinematics",
        "model",
        "prediction",
        "redundancy",
        "plots",
        "_core",
    },
    # the rig's line
    "rig": {"errors", "validation", "machine"},
    "trajectory": {"errors", "machine", "can_setup", "circle", "plan", "kinematics"},
    "capture": {"errors", "machine", "can_setup", "circle", "plan", "record", "trajectory"},
}
COMMANDS = "cli"
"""The part that may import all others; none may import it."""

CPP_RULES = [
    # (folders, what no source in them includes, sources that may)
    (("cpp/include", "cpp/src"), re.compile(r"Python\.h|pybind11/"), set()),
    (("cpp/include", "cpp/src", "cpp/bindings"), re.compile(r"ceres/"), {"diagnosis.cpp"}),
]


def module_name(path: Path) -> str:
    parts = ("hexdbb", *path.relative_to(PACKAGE).with_suffix("").parts)
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imported_names(source: str, package: str) -> set[str]:
    """Dotted names a source imports, wherever in it the import stands; `package` resolves relative ones."""
    names = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            above = package.split(".")[: len(package.split(".")) + 1 - node.level] if node.level else []
            base = ".".join([*above, *([node.module] if node.module else [])])
            names |= {f"{base}.{alias.name}" for alias in node.names}
    return names


def part_of(name: str) -> str | None:
    """Part of the package a dotted name lies in; None outside the package, and for its root (the version)."""
    top, _, rest = name.partition(".")
    first = rest.partition(".")[0]
    return first if top == "hexdbb" and first in {*ALLOWED, COMMANDS} else None


def python_violations(module: str, source: str, package: str) -> list[str]:
    own = part_of(module)
    if module == "hexdbb":
        allowed: set[str] = set()
    elif own == COMMANDS:
        allowed = set(ALLOWED)
    elif own is None:
        return [f"{module}: not in the table of parts"]
    else:
        allowed = ALLOWED[own]
    parts = {part_of(name) for name in imported_names(source, package)} - {None, own}
    return [f"{module} imports {part}" for part in sorted(map(str, parts - allowed))]


def cpp_violations(place: str, source: str) -> list[str]:
    included = re.findall(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', source, flags=re.MULTILINE)
    return [
        f"{place} includes {header}"
        for folders, forbidden, exceptions in CPP_RULES
        if place.startswith(folders) and Path(place).name not in exceptions
        for header in included
        if forbidden.match(header)
    ]


PYTHON_FILES = sorted(PACKAGE.rglob("*.py"))
CPP_FILES = sorted(path for path in (ROOT / "cpp").rglob("*") if path.suffix in {".hpp", ".cpp", ".h"})


@pytest.mark.parametrize("path", PYTHON_FILES, ids=module_name)
def test_python_imports_follow_the_table(path: Path) -> None:
    module = module_name(path)
    package = module if path.name == "__init__.py" else module.rpartition(".")[0]
    assert python_violations(module, path.read_text(encoding="utf-8"), package) == []


def test_the_engine_includes_neither_python_nor_ceres_outside_diagnosis() -> None:
    assert CPP_FILES, "no C++ sources found"
    sources = {str(path.relative_to(ROOT)): path.read_text(encoding="utf-8") for path in CPP_FILES}
    assert [each for place, source in sources.items() for each in cpp_violations(place, source)] == []


def test_the_table_has_no_cycle_and_no_part_that_is_gone() -> None:
    order = list(TopologicalSorter(ALLOWED).static_order())
    there = {part_of(module_name(path)) for path in PYTHON_FILES} | {"_core"}
    assert [part for part in order if part not in there] == []


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("hexdbb.rig.plant", "from hexdbb import _core"),
        ("hexdbb.rig.plant", "from hexdbb.kinematics import inverse"),
        ("hexdbb.rig.plant", "def f():\n    import hexdbb.prediction"),
        ("hexdbb.rig.plant", "from ..diagnosis import diagnose"),
        ("hexdbb.rig.plant", "from .. import model"),
        ("hexdbb.model.file", "from hexdbb.rig.truth import TruthFile"),
        ("hexdbb.diagnosis", "import hexdbb.capture.session as session"),
        ("hexdbb.capture.session", "from hexdbb.rig.bus import Rig"),
        ("hexdbb.compare.tables", "from hexdbb.cli.exits import reports_errors"),
        ("hexdbb", "from hexdbb.machine import load_machine"),
        ("hexdbb.new_module", ""),
    ],
)
def test_a_forbidden_import_is_caught(module: str, source: str) -> None:
    assert len(python_violations(module, source, module.rpartition(".")[0])) == 1


@pytest.mark.parametrize(
    ("place", "source"),
    [
        ("cpp/include/hexdbb/machine.hpp", "#include <pybind11/eigen.h>"),
        ("cpp/src/kinematics.cpp", '  #  include "Python.h"'),
        ("cpp/src/prediction.cpp", "#include <ceres/ceres.h>"),
        ("cpp/include/hexdbb/diagnosis.hpp", "#include <ceres/problem.h>"),
    ],
)
def test_a_forbidden_include_is_caught(place: str, source: str) -> None:
    assert len(cpp_violations(place, source)) == 1
