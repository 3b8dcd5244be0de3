"""The lines of Python that do what the user of the workbench did: ``copy as script``."""

from __future__ import annotations

from dataclasses import dataclass, field

HEAD = ("import numpy as np", "", "import hexdbb as hx", "")


@dataclass
class Script:
    """Steps in the order in which they were done, each one line or more.

    A step with the key of the step before takes its place: of a slider that is dragged the last value is kept.
    """

    steps: list[tuple[str, tuple[str, ...]]] = field(default_factory=list)

    def add(self, *lines: str, key: str = "") -> None:
        """Append a step."""
        if key and self.steps and self.steps[-1][0] == key:
            self.steps.pop()
        self.steps.append((key, lines))

    @property
    def lines(self) -> list[str]:
        """Lines of all steps."""
        return [line for _, lines in self.steps for line in lines]

    @property
    def text(self) -> str:
        """The whole script, ready to be run in the folder in which the workbench was started."""
        return "\n".join([*HEAD, *self.lines]) + "\n"


def call(function: str, *arguments: object) -> str:
    """Return a call as Python writes it; arguments that are names in the script are given as `Name`."""
    return f"{function}({', '.join(str(each) if isinstance(each, Name) else repr(each) for each in arguments)})"


class Name(str):
    """A name of the script, written as it is."""
