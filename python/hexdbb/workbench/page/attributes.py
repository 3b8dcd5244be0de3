"""HTML attributes of elements whose values hold names of the user's."""

from __future__ import annotations


def attribute(name: str, value: str) -> str:
    """Return an attribute as `nicegui.element.Element.props` takes it, whatever characters the value has."""
    plain = value.replace("\\", "/").replace('"', "'")
    return f'{name}="{plain}"'


def mark(name: str) -> str:
    """Return the attribute by which scripts and tests find an element."""
    return attribute("data-mark", name)
