"""Libraries imported in a thread while a command computes."""

from __future__ import annotations

import sys
import threading
from pathlib import Path

import pytest

from hexdbb.cli.imports_beside import imported_beside


@pytest.fixture
def written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder of modules that can be imported."""
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "beside_good.py").write_text("import threading\nTHREAD = threading.current_thread().name\n")
    (tmp_path / "beside_bad.py").write_text("raise ValueError('broken')\n")
    return tmp_path


@pytest.mark.usefixtures("written")
def test_they_are_there_after_the_block_and_none_of_the_thread_is_left() -> None:
    with imported_beside(("beside_good",)):
        pass
    assert sys.modules.pop("beside_good").THREAD == "imports"
    assert "imports" not in {each.name for each in threading.enumerate()}


@pytest.mark.usefixtures("written")
def test_what_fails_raises_where_it_is_used_and_keeps_nothing_else_from_being_imported() -> None:
    with imported_beside(("beside_bad", "beside_good")):
        pass
    assert sys.modules.pop("beside_good")
    with pytest.raises(ValueError, match="broken"):
        __import__("beside_bad")


@pytest.mark.usefixtures("written")
def test_an_error_of_the_block_is_raised() -> None:
    with pytest.raises(KeyError), imported_beside(("beside_good",)):
        raise KeyError
    assert sys.modules.pop("beside_good")
