"""Delimited text as cells: encoding, delimiter and decimal mark are detected where they are not given.

Encoding: a byte order mark decides; else UTF-8 where the file is valid UTF-8, else the code page of Western European
Windows, in which spreadsheet programs save. Delimiter: the first of semicolon, tab, bar, comma, blanks that parts the
lines into columns of numbers; a comma that is the decimal mark is looked at last.
"""

from __future__ import annotations

import codecs
import csv
import re
from collections.abc import Sequence
from pathlib import Path

from hexdbb.errors import InputError
from hexdbb.files.delimited import rows_of
from hexdbb.importing.grid import Cell, Grid
from hexdbb.importing.mapping import DELIMITERS, Mapping
from hexdbb.importing.numbers import decimal_mark, reader

MARKS = {codecs.BOM_UTF8: "utf-8-sig", codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}
FALLBACK = "cp1252"
MOST_BYTES = 500_000_000
"""Largest file that is read, bytes: a day of readings at 250 Hz with all columns in text is 4e8."""
LOOKED_AT = 2000
"""Lines by which the delimiter is chosen, and bytes by which an encoding is: beyond any preamble."""
SPREAD = 0.6
"""Part of the lines that must hold something for empty ones to part tables."""
LINE_END = re.compile(r"\r\n|\r|\n")
COMMENT = re.compile(r"^\s*[#%]\s*")
"""What marks a line of names or notes in the files of numerical programs; it is no name itself."""
PRESENT = 0.5
"""Part of the most numeric rows that any delimiter gives, from which an earlier one of the list is taken."""


def read_text_grid(path: Path, mapping: Mapping) -> Grid:
    """Read a delimited text file.

    Raises
    ------
    InputError
        It cannot be read, is no text, or its decimal mark is not clear.
    """
    text, encoding = _decoded(path, mapping.encoding)
    lines = [COMMENT.sub("", line) for line in LINE_END.split(text.removesuffix("\n").removesuffix("\r"))]
    delimiter = mapping.delimiter or _delimiter(lines[:LOOKED_AT])
    numbered = list(_split(path, lines, delimiter))
    filled = [(line, cells) for line, cells in numbered if any(cell.strip() for cell in cells)]
    if len(filled) < SPREAD * len(numbered):  # as when line ends are written twice
        numbered = filled
    rows: list[list[Cell]] = [[cell.strip() for cell in cells] for _, cells in numbered]
    texts = (cell for cells in rows for cell in cells if isinstance(cell, str))
    decimal = mapping.decimal or decimal_mark(texts, str(path))
    shown = {".": "decimal point", ",": "decimal comma"}.get(decimal or "", "whole numbers")
    how = f"text, {encoding}, delimiter {delimiter}, {shown}"
    number = reader(decimal or ".")
    return Grid(str(path), rows, [line for line, _ in numbered], "line", number, how)


def _decoded(path: Path, encoding: str | None) -> tuple[str, str]:
    try:
        if path.stat().st_size > MOST_BYTES:
            raise InputError(f"{path}: {path.stat().st_size} bytes (expected {MOST_BYTES} at most)")
        content = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    marked = next((name for mark, name in MARKS.items() if content.startswith(mark)), None) or _unmarked_utf16(content)
    for name in (encoding,) if encoding else (marked,) if marked else ("utf-8", FALLBACK):
        try:
            text = content.decode(str(name))
        except LookupError:
            expected = "one that Python has, as utf-8, cp1252, utf-16"
            raise InputError(f'{path}: encoding: "{name}" (expected {expected})') from None
        except UnicodeDecodeError as error:
            where = f"byte {error.start} is not {name}"
            continue
        if "\0" in text:
            raise InputError(f"{path}: byte {content.find(0)} is zero (expected text; --encoding names the encoding)")
        return text, str(name)
    raise InputError(f"{path}: {where} (expected text; --encoding names the encoding)")


def _unmarked_utf16(content: bytes) -> str | None:
    """Return the encoding of a text of two bytes a character without its byte order mark; None where it is none."""
    looked_at = content[:LOOKED_AT]
    zeros = looked_at.count(0)
    for place, name in ((1, "utf-16-le"), (0, "utf-16-be")):
        if zeros and zeros == looked_at[place::2].count(0) >= PRESENT * (len(looked_at) // 2):
            return name
    return None


def _split(path: Path, lines: Sequence[str], delimiter: str) -> list[tuple[int, list[str]]]:
    """Return line number (from 1) and cells of every line, empty ones included."""
    if delimiter == "space":
        return [(place, line.split()) for place, line in enumerate(lines, 1)]
    return list(rows_of((f"{line}\n" for line in lines), str(path), DELIMITERS[delimiter], keep_empty=True))


def _delimiter(lines: Sequence[str]) -> str:
    counts = {name: _numeric_rows(lines, name) for name in ("semicolon", "tab", "bar", "comma", "space")}
    most = max(counts.values(), default=0)
    return next((name for name, count in counts.items() if count and count >= PRESENT * most), "comma")


def _numeric_rows(lines: Sequence[str], delimiter: str) -> int:
    """Return how many lines a delimiter parts into two numbers or more and no cell that is nearly one."""
    marks = "." if delimiter == "comma" else ".,"
    readers = [reader(mark) for mark in marks]
    count = 0
    for line in lines:
        try:
            cells = line.split() if delimiter == "space" else next(csv.reader([line], delimiter=DELIMITERS[delimiter]))
        except (csv.Error, StopIteration):
            continue
        cells = [cell.strip() for cell in cells]
        numbers = sum(any(number(cell) is not None for number in readers) for cell in cells)
        digits = sum(bool(re.search(r"\d[;\t|]\s*-?\d", cell)) for cell in cells)
        count += numbers >= 2 and not digits
    return count
