"""Build the documentation site: `python -m docs.site FOLDER`.

The pages of the project are staged in FOLDER/source, the references of commands, Python, C++ and C are written beside
them, figures are drawn, and Sphinx makes FOLDER/html of it. A warning, a page in no section of docs/README.md and a
link within the site that leads nowhere are errors.
"""

from __future__ import annotations

import argparse
import shutil
import sys
from pathlib import Path

from docs.site import command_reference, header_reference, python_reference, results_reference
from docs.site.figures import draw_figures
from docs.site.links import broken_links
from docs.site.staging import copy, stage
from sphinx.cmd.build import build_main

ROOT = Path(__file__).parents[2]
HERE = Path(__file__).parent


def build(folder: Path) -> int:
    """Build the site in a folder; return 0, or 1 where something is wrong, which is printed."""
    source, html = folder / "source", folder / "html"
    for old in (source, html, folder / "drawn"):
        shutil.rmtree(old, ignore_errors=True)
    source.mkdir(parents=True)
    try:
        stage(ROOT, source)
        for picture in draw_figures(folder / "drawn" / "docs"):
            copy(picture, folder / "drawn", source)
        for each in (command_reference, python_reference):
            each.write_pages(source / "reference")
        results_reference.write_page(source / "reference")
        header_reference.write_pages(ROOT, source / "reference")
    except ValueError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    options = ["-b", "html", "-W", "--keep-going", "-q", "-j", "auto", "-c", str(HERE), "-d", str(folder / "doctrees")]
    if build_main([*options, str(source), str(html)]) != 0:
        return 1
    broken = broken_links(html)
    for link in broken:
        print(f"error: link leads nowhere: {link}", file=sys.stderr)
    if not broken:
        print(f"{html / 'index.html'}: {len(list(html.rglob('*.html')))} pages")
    return 1 if broken else 0


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="folder of the site, as build/site")
    sys.exit(build(parser.parse_args().folder))
