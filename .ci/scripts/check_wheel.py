"""Inspect a wheel: `check_wheel.py WHEEL`: files as in the sources, programs and licences in it, no C++ needed.

What a wheel of Linux may ask of the system is what every installation of Python has: libc, libstdc++ and libgcc.
"""

from __future__ import annotations

import io
import sys
import tomllib
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
SYSTEM = {"libc.so.6", "libm.so.6", "libstdc++.so.6", "libgcc_s.so.1", "libpthread.so.0", "ld-linux-x86-64.so.2"}
SYSTEM |= {"ld-linux-aarch64.so.1"}
PROGRAMS = {"hexdbb", "hexdbb-run"}
"""Compiled (cpp/start); installers put them beside the environment's Python."""


def expected_files(root: Path) -> set[str]:
    """Return the files that a wheel has beside the compiled module: all sources and data of its packages."""
    packages = [root / each for each in _pyproject(root)["tool"]["scikit-build"]["wheel"]["packages"]]
    found = (path for package in packages for path in package.rglob("*") if path.is_file())
    return {
        path.relative_to(root / "python").as_posix()
        for path in found
        if "__pycache__" not in path.parts and path.suffix != ".so"
    }


def licences(root: Path) -> set[str]:
    """Return the licence files of a tree as a wheel names them."""
    patterns = _pyproject(root)["project"]["license-files"]
    return {path.relative_to(root).as_posix() for pattern in patterns for path in root.glob(pattern)}


def faults(wheel: Path, root: Path = ROOT) -> Iterator[str]:
    """Yield what is wrong with a wheel of the tree at root."""
    with zipfile.ZipFile(wheel) as archive:
        names = {name for name in archive.namelist() if not name.endswith("/")}  # auditwheel enters folders too
        inside = {name for name in names if ".dist-info/" not in name}
        programs = {
            name for name in inside if Path(name).parent.match("*.data/scripts") and Path(name).name in PROGRAMS
        }
        module = {name for name in inside if name.startswith("hexdbb/_core.") and name.endswith(".so")}
        files = expected_files(root)
        yield from (f"lacks {name}" for name in sorted(files - inside))
        yield from (
            f"has {name}, which is no file of the packages" for name in sorted(inside - files - module - programs)
        )
        held = {name.partition(".dist-info/licenses/")[2] for name in names}
        yield from (f"lacks the licence {name}" for name in sorted(licences(root) - held))
        yield from (f"lacks the program {name}" for name in sorted(PROGRAMS - {Path(each).name for each in programs}))
        if len(module) != 1:
            yield f"has {len(module)} compiled modules (expected hexdbb/_core)"
        elif "linux" in wheel.name:
            needed = {name for binary in module | programs for name in _needed(archive.read(binary))}
            yield from (f"needs {name} of the system" for name in sorted(needed - SYSTEM))


def _needed(binary: bytes) -> set[str]:
    """Return the shared libraries that a compiled module or program is linked with."""
    from elftools.elf.dynamic import DynamicSection  # a tool of `make wheel` alone
    from elftools.elf.elffile import ELFFile

    section = ELFFile(io.BytesIO(binary)).get_section_by_name(".dynamic")
    assert isinstance(section, DynamicSection)
    return {tag.needed for tag in section.iter_tags() if tag.entry.d_tag == "DT_NEEDED"}


def _pyproject(root: Path) -> dict[str, Any]:
    return tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))


def main() -> None:
    """Print what is wrong with the wheel named by the command line; end with 1 if anything is."""
    found = list(faults(Path(sys.argv[1])))
    print(*(f"error: {sys.argv[1]} {each}" for each in found), sep="\n")
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
