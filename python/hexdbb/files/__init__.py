"""Files in general: validated TOML, files written whole or not at all, columns as tables."""

from hexdbb.files.atomic_file import replacing
from hexdbb.files.frames import html_table, to_frame

__all__ = ["html_table", "replacing", "to_frame"]
