"""A declared result: its JSON and its schema are those of the type, and a value of another type is seen."""

from __future__ import annotations

import json
import warnings
from dataclasses import dataclass

import jsonschema
import numpy as np
import pytest

from hexdbb.files.results import JsonPart, JsonResult, NotNegative, number_or_none


@dataclass(frozen=True)
class Wave(JsonPart):
    """One sine."""

    order: int
    """Periods per turn."""
    amplitude_um: NotNegative
    """Half of the whole height."""


@dataclass(frozen=True)
class Waves(JsonResult):
    """Sines of a residual."""

    SCHEMA = "hexdbb.waves/3"

    waves: tuple[Wave, ...]
    """In order."""
    title: str | None
    """Where it has one."""


def validated(data: object) -> None:
    jsonschema.validate(data, Waves.json_schema(), jsonschema.Draft202012Validator)


def test_an_object_holds_its_schemas_id_and_fulfils_it() -> None:
    found = Waves((Wave(1, 0.5),), None).to_json()
    assert found == {"schema": "hexdbb.waves/3", "waves": [{"order": 1, "amplitude_um": 0.5}], "title": None}
    validated(json.loads(json.dumps(found)))


def test_the_schema_carries_descriptions_limits_and_required_keys() -> None:
    schema = Waves.json_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    assert schema["title"] == "hexdbb waves --json"
    assert schema["description"] == "Sines of a residual."
    assert schema["required"] == ["schema", "waves", "title"]
    assert schema["properties"]["title"]["description"] == "Where it has one."
    assert schema["$defs"]["Wave"]["properties"]["amplitude_um"] == {
        "description": "Half of the whole height.",
        "minimum": 0.0,
        "type": "number",
    }


@pytest.mark.parametrize(
    "wrong",
    [
        {"schema": "hexdbb.waves/2", "waves": [], "title": None},
        {"schema": "hexdbb.waves/3", "waves": []},
        {"schema": "hexdbb.waves/3", "waves": [{"order": 1, "amplitude_um": -0.5}], "title": None},
        {"schema": "hexdbb.waves/3", "waves": [{"order": 1.5, "amplitude_um": 0.5}], "title": None},
    ],
)
def test_what_differs_is_refused(wrong: object) -> None:
    with pytest.raises(jsonschema.ValidationError):
        validated(wrong)


def test_a_value_of_another_type_is_seen_when_it_is_written() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(UserWarning, match="title"):
            Waves((), 7).to_json()  # type: ignore[arg-type]


def test_nan_is_null() -> None:
    assert number_or_none(float("nan")) is None
    assert number_or_none(np.float64(2.0)) == 2.0
