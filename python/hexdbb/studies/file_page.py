"""Table of keys of the page on studies, generated from the model that validates the study file.

To rewrite the committed page: ``python -m hexdbb.studies.file_page docs``.
"""

from __future__ import annotations

import sys
from pathlib import Path

from hexdbb.record.file_pages import key_tables, replaced
from hexdbb.studies.file import StudyFile

PAGE = "studies.md"
BEGIN = "<!-- keys: made by `python -m hexdbb.studies.file_page docs`; do not edit -->"
END = "<!-- end of keys -->"


def updated(page: str) -> str:
    """Return the page's text with its tables generated anew."""
    return replaced(page, BEGIN, END, key_tables(StudyFile))


def main(folder: Path) -> None:
    """Rewrite the tables of the page in a folder."""
    page = folder / PAGE
    page.write_text(updated(page.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
