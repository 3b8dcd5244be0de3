"""hexdbb: why a HexGlider parallel manipulator does not go where it is told, by a double-ball-bar circular test."""

from importlib.metadata import version as _version

__version__ = _version("hexdbb")
