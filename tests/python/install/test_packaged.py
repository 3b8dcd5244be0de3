"""What a wheel says of itself and holds, from the sources alone; `make wheel` inspects and tries a real one."""

from __future__ import annotations

import importlib.util
import tomllib
import zipfile
from importlib.metadata import EntryPoint, PathDistribution
from pathlib import Path
from types import ModuleType

import pytest

from hexdbb import __version__

ROOT = Path(__file__).parents[3]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def _script(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, ROOT / ".ci" / "scripts" / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


check_wheel = _script("check_wheel")


@pytest.fixture(scope="module")
def distribution(tmp_path_factory: pytest.TempPathFactory) -> PathDistribution:
    """Metadata as pip gets them before it compiles anything."""
    from scikit_build_core import build

    folder = tmp_path_factory.mktemp("metadata")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(ROOT)
        return PathDistribution(folder / build.prepare_metadata_for_build_wheel(str(folder)))


def test_metadata(distribution: PathDistribution) -> None:
    assert distribution.metadata["Name"] == "hexdbb"
    assert distribution.version == __version__
    assert distribution.metadata["Requires-Python"] == ">=3.11"
    wanted = [each for each in distribution.requires or [] if "extra ==" not in each]
    assert len(wanted) == len(PROJECT["dependencies"])


def test_licences_of_what_is_compiled_in(distribution: PathDistribution) -> None:
    named = set(distribution.metadata.get_all("License-File") or [])
    assert named == check_wheel.licences(ROOT)
    assert {Path(each).stem for each in named} == {"LICENSE", "ceres-solver", "eigen", "pybind11"}


def test_the_script_of_the_programs_is_a_function(distribution: PathDistribution) -> None:
    commands = [each for each in distribution.entry_points if each.group == "console_scripts"]
    assert {each.name for each in commands} == {"hexdbb-start"}
    assert all(_is_packaged(each) and callable(each.load()) for each in commands)


def _is_packaged(command: EntryPoint) -> bool:
    return f"{command.module}/__init__.py" in check_wheel.expected_files(ROOT)


def test_files_are_data_and_sources_without_tests() -> None:
    files = check_wheel.expected_files(ROOT)
    assert {each.partition("/")[0] for each in files} == {"hexdbb", "hexdbb_start", "hexdbb_truth"}
    data = {"hexdbb/py.typed", "hexdbb/_core.pyi", "hexdbb/data/sp120.toml", "hexdbb/data/plans/standard.toml"}
    assert data <= files
    assert not [each for each in files if Path(each).name.startswith(("test_", "conftest")) or "/tests/" in each]


def test_a_wheel_that_lacks_or_adds_is_noticed(tmp_path: Path) -> None:
    wheel = tmp_path / "hexdbb-0-cp311-cp311-macosx_14_0_arm64.whl"
    files = sorted(check_wheel.expected_files(ROOT) - {"hexdbb/data/sp120.toml"})
    with zipfile.ZipFile(wheel, "w") as archive:
        for name in [
            *files,
            "hexdbb/_core.cpython-311-darwin.so",
            "hexdbb-0.data/scripts/hexdbb",
            "tests/test_this.py",
        ]:
            archive.writestr(name, b"")
        for name in check_wheel.licences(ROOT) - {"LICENSE"}:
            archive.writestr(f"hexdbb-0.dist-info/licenses/{name}", b"")
    assert list(check_wheel.faults(wheel)) == [
        "lacks hexdbb/data/sp120.toml",
        "has tests/test_this.py, which is no file of the packages",
        "lacks the licence LICENSE",
        "lacks the program hexdbb-run",
    ]
