"""Files as such: TOML read with validation, whole files or none, columns as tables."""

from hexdbb.files.atomic_file import replacing
from hexdbb.files.frames import html_table, to_frame

__all__ = ["html_table", "replacing", "to_frame"]
