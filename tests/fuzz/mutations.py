"""Seeded damage to files: bytes flipped, cut and repeated; in texts also lines, numbers and words exchanged."""

from __future__ import annotations

import copy
import math
import random
import re
import tomllib
from collections.abc import Callable, Iterator
from datetime import date
from typing import Any

import tomlkit

Mutation = Callable[[bytes, random.Random], bytes]

MOST_CHANGES = 4
"""Changes to one input: few, so that most of them get past the first check of their reader."""
LONGEST_SPAN = 64
NUMBER = re.compile(rb"-?[0-9]+(\.[0-9]+)?([eE][-+]?[0-9]+)?")
WORD = re.compile(rb"[A-Za-z_][A-Za-z_0-9.]*")
ODD_VALUES = [
    b"nan", b"inf", b"-inf", b"1e400", b"-1e308", b"1e-320", b"-0.0", b"0", b"-1", b"1", b"2147483648", b"1e18",
    b"18446744073709551616", b"9" * 400, b"0x07 # VAR", b"0x", b"1_000", b"1,5", b"true", b"[]", b"{}", b'""', b"''",
    b'"\\u0000"', b'"x */ int evil = 1; /*"', b'"\\u001b[31m"', b'"<b>&amp;"', b"[[1, 2], [3]]", b"1979-05-27",
    b"=", b'"', b"'", b"[", b"]", b"#", b",", b";", b"\t", b"\r", b"\n", b"\r\n", b"\x00", b"\x1b[2J", b"\xff\xfe",
    b"\xef\xbb\xbf", "µ°".encode(), "\u2028".encode(), "\u202e".encode(), b"$NODEID", b"$NODEID+0x", b"../" * 20,
]  # fmt: skip
"""Values and marks that readers of numbers, texts and tables have been tripped up by."""
DEPTH = 3000
"""Nesting beyond the recursion limit of Python."""


def _span(data: bytes, rng: random.Random) -> tuple[int, int]:
    begin = rng.randrange(len(data) + 1)
    return begin, min(len(data), begin + 1 + rng.randrange(LONGEST_SPAN))


def flip_bit(data: bytes, rng: random.Random) -> bytes:
    """Flip one bit."""
    at = rng.randrange(len(data)) if data else 0
    return data[:at] + bytes([data[at] ^ 1 << rng.randrange(8)]) + data[at + 1 :] if data else data


def cut(data: bytes, rng: random.Random) -> bytes:
    """Remove some bytes."""
    begin, end = _span(data, rng)
    return data[:begin] + data[end:]


def truncate(data: bytes, rng: random.Random) -> bytes:
    """Remove the end."""
    return data[: rng.randrange(len(data) + 1)]


def repeat(data: bytes, rng: random.Random) -> bytes:
    """Repeat some bytes, at times often."""
    begin, end = _span(data, rng)
    return data[:end] + data[begin:end] * rng.choice((1, 1, 1, 2, 50)) + data[end:]


def insert(data: bytes, rng: random.Random) -> bytes:
    """Insert an odd value or random bytes."""
    at = rng.randrange(len(data) + 1)
    return (
        data[:at] + (rng.choice(ODD_VALUES) if rng.random() < 0.7 else rng.randbytes(rng.randrange(1, 9))) + data[at:]
    )


def exchange_number(data: bytes, rng: random.Random) -> bytes:
    """Put another value in place of a number."""
    found = list(NUMBER.finditer(data))
    if not found:
        return insert(data, rng)
    match = rng.choice(found)
    if rng.random() < 0.5:
        value = rng.choice(ODD_VALUES)
    else:
        value = f"{float(match[0]) * rng.choice((-1.0, 0.0, 1e-6, 0.5, 1.001, 10.0, 1e6)):g}".encode()
    return data[: match.start()] + value + data[match.end() :]


def exchange_words(data: bytes, rng: random.Random) -> bytes:
    """Put one word of the file in place of another."""
    found = list(WORD.finditer(data))
    if not found:
        return insert(data, rng)
    there, other = rng.choice(found), rng.choice(found)
    return data[: there.start()] + (other[0] if rng.random() < 0.7 else b"") + data[there.end() :]


def shuffle_lines(data: bytes, rng: random.Random) -> bytes:
    """Remove, repeat or exchange lines."""
    lines = data.split(b"\n")
    one, other = rng.randrange(len(lines)), rng.randrange(len(lines))
    kind = rng.randrange(3)
    if kind == 0:
        del lines[one]
    elif kind == 1:
        lines.insert(other, lines[one])
    else:
        lines[one], lines[other] = lines[other], lines[one]
    return b"\n".join(lines)


def nest(data: bytes, rng: random.Random) -> bytes:
    """Nest brackets deeper than a recursive reader may go."""
    at = data.find(b"=", rng.randrange(len(data) + 1)) + 1
    left, right = rng.choice(((b"[", b"]"), (b"{a=", b"}"), (b"a.", b"")))
    return data[:at] + left * DEPTH + b"1" + right * DEPTH + b"\n" + data[at:]


def line_ends(data: bytes, rng: random.Random) -> bytes:
    """Use other line ends or another encoding of the text."""
    text = data.decode(errors="replace")
    return rng.choice(
        (data.replace(b"\n", b"\r\n"), data.replace(b"\n", b"\r"), text.encode("utf-16"), b"\xef\xbb\xbf" + data)
    )


ODD_OBJECTS: list[object] = [
    math.nan, math.inf, -math.inf, 1e308, -1e308, 5e-324, 0, -1, 1, 0.0, -0.0, 2**31, 2**63 - 1, -(2**63), True, False,
    "", "x" * 5000, "a\nb", "\x00", "\x1b[31m", "\u202e", "x */ int evil = 1; /*", "../../etc/passwd", "/dev/null",
    ".", [], {}, [[]], [1, 2], [1.0, 2.0, 3.0], ["a"], [0.0] * 1000, {"a": 1}, date(1979, 5, 27),
]  # fmt: skip
"""Values of every type of TOML."""


def exchange_value(data: bytes, rng: random.Random) -> bytes:
    """Change a value or a key of a TOML file that stays TOML; damage it otherwise where it is none any more."""
    try:
        tree = tomllib.loads(data.decode())
    except (ValueError, RecursionError):
        return exchange_number(data, rng)
    places = list(_places(tree))
    if not places:
        return insert(data, rng)
    inside, key = rng.choice(places)
    kind = rng.randrange(8)
    if kind == 0:
        del inside[key]
    elif kind == 1 and isinstance(inside, dict):
        inside[rng.choice(("", "a b", "\x1b[2J", "µ", str(key) + "s", str(rng.choice(places)[1])))] = inside.pop(key)
    elif kind == 2:
        other, there = rng.choice(places)
        inside[key] = copy.deepcopy(other[there])
    elif kind == 3 and isinstance(inside, list):
        inside.insert(key, copy.deepcopy(inside[key]))
    elif isinstance(inside[key], int | float) and not isinstance(inside[key], bool) and rng.random() < 0.5:
        inside[key] = type(inside[key])(inside[key] * rng.choice((-1, 0, 1e-6, 0.5, 1.001, 10, 1e6)))
    else:
        inside[key] = copy.deepcopy(rng.choice(ODD_OBJECTS))
    return tomlkit.dumps({str(name): value for name, value in tree.items()}).encode()


def _places(tree: Any) -> Iterator[tuple[Any, Any]]:
    """Yield container and key of every value below a tree."""
    for key in tree if isinstance(tree, dict) else range(len(tree)):
        yield tree, key
        if isinstance(tree[key], dict | list):
            yield from _places(tree[key])


BINARY: list[Mutation] = [flip_bit, flip_bit, flip_bit, cut, truncate, repeat, insert]
TEXT: list[Mutation] = [
    flip_bit, cut, truncate, repeat, insert, insert, exchange_number, exchange_number, exchange_number, exchange_words,
    exchange_words, shuffle_lines, shuffle_lines,
]  # fmt: skip
TOML: list[Mutation] = [*[exchange_value] * 13, *TEXT]
RARE: list[Mutation] = [nest, line_ends]
RARELY = 0.02


def damaged(data: bytes, mutations: list[Mutation], rng: random.Random) -> bytes:
    """Return data with a few random changes."""
    if mutations is not BINARY and rng.random() < RARELY:
        return rng.choice(RARE)(data, rng)
    for _ in range(rng.randint(1, MOST_CHANGES)):
        data = rng.choice(mutations)(data, rng)
    return data
