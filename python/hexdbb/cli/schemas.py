"""Published JSON Schemas (draft 2020-12) of what commands print with ``--json``; they lie in `data/schemas`.

A schema follows from the declared type of the result (`hexdbb.files.results`); the file is what other programs read.
``python -m hexdbb.cli.schemas`` writes the files anew. Keys are stable within a version: a later program may add some
and takes none away. The schemas therefore allow keys they do not name.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from hexdbb.capture.json_form import EdsCheckJson
from hexdbb.comparison.json_form import ComparisonJson
from hexdbb.diagnosis.json_form import DiagnosisJson
from hexdbb.discovery.json_form import DiscoveryJson
from hexdbb.errors import InputError
from hexdbb.files.results import JsonResult
from hexdbb.fleet.json_form import FleetReportJson
from hexdbb.ledger.json_form import AddedJson, HistoryJson, UndoneJson
from hexdbb.logbook.json_form import LogJson
from hexdbb.machine import shipped
from hexdbb.reporting.json_form import ReportJson
from hexdbb.trend.json_form import TrendJson

DECLARED: dict[str, type[JsonResult]] = {
    "diagnose": DiagnosisJson,
    "compare": ComparisonJson,
    "discover": DiscoveryJson,
    "add": AddedJson,
    "undo": UndoneJson,
    "history": HistoryJson,
    "eds": EdsCheckJson,
    "report": ReportJson,
    "log": LogJson,
    "trend": TrendJson,
    "fleet": FleetReportJson,
}
"""Declared result of each command that has a schema."""
COMMANDS = tuple(DECLARED)
"""Commands with a schema."""


def json_schema(command: str) -> dict[str, Any]:
    """Return the schema of what ``hexdbb COMMAND --json`` prints.

    Raises
    ------
    InputError
        A command that has none, with those that have one.
    """
    if command not in COMMANDS:
        raise InputError(f'no JSON schema of "{command}" (expected one of {", ".join(COMMANDS)})')
    schema: dict[str, Any] = json.loads(shipped("schemas", f"{command}.schema.json").read_text(encoding="utf-8"))
    return schema


def schema_text(command: str) -> str:
    """Return the text of a command's schema file, made of the declared type."""
    return json.dumps(DECLARED[command].json_schema(), indent=2, ensure_ascii=False) + "\n"


def write_schemas(folder: Path) -> None:
    """Write the schema file of every command that has one."""
    for command in DECLARED:
        (folder / f"{command}.schema.json").write_text(schema_text(command), encoding="utf-8")


if __name__ == "__main__":
    write_schemas(Path(__file__).parents[1] / "data" / "schemas")
