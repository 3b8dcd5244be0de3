"""Configuration of Sphinx for the documentation site."""

from __future__ import annotations

import sys
from importlib.metadata import version as installed_version
from pathlib import Path

from sphinx.application import Sphinx

sys.path.insert(0, str(Path(__file__).parents[2]))  # processes that Sphinx starts import this file by its path

from docs.site.command_reference import show_examples_as_code

project = "hexdbb"
version = release = installed_version("hexdbb")

extensions = ["myst_parser", "sphinx.ext.autodoc", "numpydoc", "sphinx_click", "sphinx_copybutton"]
root_doc = "index"
nitpicky = False  # types in signatures are those of numpy and click, too, which are not described here

myst_heading_anchors = 4  # as a forge makes them, so that links to headings hold on both
myst_enable_extensions: list[str] = []

smartquotes = False  # `--json` has two hyphens
default_role = "code"  # docstrings and comments mark code by single backticks
highlight_language = "console"
add_module_names = False
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_class_signature = "separated"
numpydoc_show_class_members = False  # autodoc lists them
maximum_signature_line_length = 90
copybutton_prompt_text = "$ "
copybutton_only_copy_prompt_lines = True

html_theme = "furo"
html_title = f"hexdbb {version}"
html_copy_source = False
html_show_sphinx = False
html_show_copyright = False
templates_path: list[str] = []
html_static_path = ["_static"]
html_css_files = ["site.css"]


def setup(app: Sphinx) -> None:
    """Let Sphinx call what is done to the texts of commands."""
    app.connect("sphinx-click-process-description", show_examples_as_code)
