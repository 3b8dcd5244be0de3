"""Who may import whom: the directions of docs/architecture.md, read from the sources' own import statements.

The lines machine -> ... -> report and rig -> capture -> record meet in the commands only. The simulated rig and the
truth simulator hold the truth that predictions are judged by and share no code path with them; the C++ engine knows
neither Python nor, outside the diagnosis, Ceres.
"""

from __future__ import annotations

import ast
import re
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

from hexdbb import _core

ROOT = Path(__file__).parents[2]
SOURCES = ROOT / "python"
PACKAGE = SOURCES / "hexdbb"
TRUTH = "hexdbb_truth"
"""The package of the truth simulator, beside hexdbb; a part of the table like those of hexdbb."""

# Each part of the package (a package with all that is in it) and the parts it may import.
ALLOWED: dict[str, set[str]] = {
    part: set(others.split())
    for part, others in {
        "errors": "",
        "units": "",
        "_core": "",
        "threads": "",
        "files": "errors",
        # many tasks on Dask, whatever they compute
        "cluster": "errors files _core",
        # what is measured on, and what is asked of it
        "machine": "errors files",
        "kinematics": "errors machine _core",
        "plan": "errors files machine kinematics",
        "record": "errors files machine plan",
        # readings of other programs as records
        "importing": "errors files machine kinematics plan record",
        # the machine's line
        "learned": "errors _core",
        "model": "errors files units machine kinematics learned _core",
        "samples": "errors files machine plan record kinematics model _core",
        "effects": "errors units machine plan kinematics learned model samples _core",
        "identifiability": "errors plan record kinematics model samples _core",
        "diagnosis": "errors files threads units plan record kinematics model samples identifiability learned _core",
        "ledger": "errors files threads units record learned model samples diagnosis _core",
        # which variables of the samples predict a residual
        "predictors": "record kinematics model samples effects _core",
        # hypotheses on what is missing, decided by their evidence
        "evidence": "errors threads units machine learned model samples diagnosis predictors _core",
        "discovery": (
            "errors files threads units plan record kinematics learned model samples effects diagnosis ledger "
            "predictors evidence _core"
        ),
        # where the model fails, and the likely cause; readings come in as arrays, predicted or measured
        "comparison": "errors files threads units plan record model samples diagnosis predictors discovery _core",
        # what changes over the records of years
        "trend": ("errors files threads units machine record model samples identifiability diagnosis comparison _core"),
        # every error's part in the circular deviation
        "contributions": (
            "errors files threads learned model samples diagnosis identifiability ledger predictors comparison charts"
        ),
        # what pictures and pages show, before either draws it
        "charts": "comparison",
        "plots": (
            "errors files units machine kinematics workspace plan learned model samples diagnosis predictors "
            "discovery comparison trend charts"
        ),
        # one file to hand over; nothing is computed in it
        "reporting": (
            "errors files threads units machine plan record model samples identifiability diagnosis ledger "
            "predictors comparison contributions charts"
        ),
        # the records of many machines
        "fleet": (
            "errors files threads units machine record importing model samples diagnosis discovery comparison "
            "trend reporting cluster"
        ),
        # what a controller does about it
        "trajectory": "errors machine plan kinematics",
        "compensation": "errors files machine record kinematics model trajectory _core",
        # a machine's files over the years
        "logbook": "errors files machine record model compensation trend",
        # which circles determine most
        "planning": "errors units machine plan kinematics model identifiability trajectory _core",
        # where a machine is wanted to go: reach, limits, singular poses
        "workspace": "errors files machine kinematics identifiability plan",
        # the thesis' own way, beside ours; the estimator judged on true machines
        "studies": (
            "hexdbb_truth errors files threads units machine plan record kinematics learned model samples "
            "identifiability diagnosis ledger evidence discovery planning plots rig cluster _core"
        ),
        # the public face, beside the commands
        "api": (
            "errors files machine plan record model samples diagnosis ledger comparison discovery "
            "compensation planning contributions reporting capture _core"
        ),
        # who may open a page, and how it is served
        "pages": "errors",
        # seen and played with: a view of what the commands do
        "workbench": (
            "errors files threads units machine kinematics plan record importing model effects samples "
            "predictors diagnosis ledger comparison discovery api charts pages _core"
        ),
        # a page that watches a run, told by it through a pipe
        "live": "errors charts pages",
        # the rig's line
        "rig": "errors files machine",
        "capture": "errors files machine plan record trajectory",
        # what the estimator is judged by: none of these parts computes a prediction
        TRUTH: "errors files machine plan record rig",
    }.items()
}
INSIDE_EVIDENCE = ("linear", "forms", "fit", "proposals", "search", "verdict")
"""Packages of the evidence, each of which may import those before it; names that only types need may come from any."""
COMMANDS = "cli"
"""The part that may import all others; none may import it."""

CPP_RULES = [
    # (folders, what no source in them includes, sources that may)
    (("cpp/include", "cpp/src"), re.compile(r"Python\.h|pybind11/"), set()),
    (("cpp/include", "cpp/src", "cpp/bindings"), re.compile(r"ceres/"), {"minimum.cpp"}),
]


def module_name(path: Path) -> str:
    parts = path.relative_to(SOURCES).with_suffix("").parts
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
    """Part of the table a dotted name lies in; None outside the packages, and for the root of hexdbb (the version)."""
    top, _, rest = name.partition(".")
    if top == TRUTH:
        return TRUTH
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


PYTHON_FILES = sorted([*PACKAGE.rglob("*.py"), *(SOURCES / TRUTH).rglob("*.py")])
CPP_FILES = sorted(path for path in (ROOT / "cpp").rglob("*") if path.suffix in {".hpp", ".cpp", ".h"})


@pytest.mark.parametrize("path", PYTHON_FILES, ids=module_name)
def test_python_imports_follow_the_table(path: Path) -> None:
    module = module_name(path)
    package = module if path.name == "__init__.py" else module.rpartition(".")[0]
    assert python_violations(module, path.read_text(encoding="utf-8"), package) == []


@pytest.mark.parametrize("part", INSIDE_EVIDENCE)
def test_the_evidence_is_built_one_way(part: str) -> None:
    later = INSIDE_EVIDENCE[INSIDE_EVIDENCE.index(part) + 1 :]
    imported = {
        node.module
        for path in (PACKAGE / "evidence" / part).glob("*.py")
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.ImportFrom) and node.module
    }
    assert any(module.startswith("hexdbb.") for module in imported)
    assert not [module for module in imported if module.startswith(tuple(f"hexdbb.evidence.{one}." for one in later))]


def test_every_module_of_the_evidence_has_its_package() -> None:
    packages = {path.name for path in (PACKAGE / "evidence").iterdir() if (path / "__init__.py").exists()}
    assert packages == {*INSIDE_EVIDENCE}
    assert {path.name for path in (PACKAGE / "evidence").glob("*.py")} == {"__init__.py", "criteria.py"}


def test_only_errors_and_units_lie_loose_in_the_package() -> None:
    loose = {path.stem for path in PACKAGE.glob("*.py")}
    assert loose == {"__init__", "errors", "units"}


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
        ("hexdbb.rig.plant", "def f():\n    import hexdbb.samples"),
        ("hexdbb.rig.plant", "from ..diagnosis import diagnose"),
        ("hexdbb.rig.plant", "from .. import model"),
        ("hexdbb.model.file", "from hexdbb.rig.truth import TruthFile"),
        ("hexdbb.diagnosis", "import hexdbb.capture.session as session"),
        ("hexdbb.capture.session", "from hexdbb.rig.bus import Rig"),
        ("hexdbb.comparison.tables", "from hexdbb.cli.exits import reports_errors"),
        ("hexdbb", "from hexdbb.machine import load_machine"),
        ("hexdbb.new_module", ""),
        ("hexdbb.diagnosis.fit", "from hexdbb_truth.simulate import simulate"),
        ("hexdbb.discovery", "import hexdbb_truth"),
        ("hexdbb.rig.truth", "from hexdbb_truth import plans"),
        ("hexdbb_truth.forms.fit", "from hexdbb.diagnosis import diagnose"),
        ("hexdbb_truth.cases", "from hexdbb import _core"),
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


def strings_of(source: str) -> set[str]:
    """String constants of a source that are not docstrings or comments of fields."""
    tree = ast.parse(source)
    free_standing = {
        id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    }
    return {
        node.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in free_standing
    }


NAME_BLIND = (
    "model",
    "samples",
    "identifiability",
    "diagnosis",
    "ledger",
    "predictors",
    "comparison",
    "trend",
    "contributions",
    "charts",
    "reporting",
    "plots",
    "evidence",
    "discovery",
    "workbench",
    "fleet",
)
"""Parts that work on any list of effects and know none by name."""


@pytest.mark.parametrize(
    "path", [path for path in PYTHON_FILES if part_of(module_name(path)) in NAME_BLIND], ids=module_name
)
def test_no_effect_is_known_by_name_above_effects(path: Path) -> None:
    named = strings_of(path.read_text(encoding="utf-8")) & set(_core.effect_names())
    assert not named


def test_only_the_ledger_makes_its_steps() -> None:
    makers = {
        module_name(path)
        for path in PYTHON_FILES
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "LedgerStep"
    }
    assert makers == {"hexdbb.ledger.step", "hexdbb.model.file"}  # made; read from a file


def test_samples_alone_give_the_engine_its_form_of_a_record() -> None:
    """A record is prepared once: nothing above the table of samples makes another."""
    makers = {
        module_name(path) for path in PYTHON_FILES if re.search(r"\b_core\.Samples\(", path.read_text(encoding="utf-8"))
    }
    # Poses without a state: bare kinematics, the ball's position read by far cups or computed by a model, the thesis'
    # nominal circle.
    bare = {
        "hexdbb.kinematics.poses",
        "hexdbb.diagnosis.place_uncertainty",
        "hexdbb.studies.thesis.circular_test",
        "hexdbb.studies.measured",
    }
    assert makers == {"hexdbb.samples.whole", *bare}
