"""Reading, validating and writing of TOML files through pydantic, with errors of one line.

Model: a file is a tree of `StrictModel`s; the key `schema` of its root holds the kind and version of the file.
Assumption: units are part of the key (`radius_mm`), so a wrong unit is an unknown key; its error names the right one.
Form of an error: `plan.toml: circle[2].radius_mm: -5 (expected a number > 0)`; lists count from 0, as in Python.
"""

from __future__ import annotations

import difflib
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, TypeVar, get_args

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    PrivateAttr,
    Tag,
    ValidationError,
)
from pydantic_core import ErrorDetails

from hexdbb.errors import InputError
from hexdbb.files.toml_text import toml_text

Location = tuple[int | str, ...]
ModelT = TypeVar("ModelT", bound=BaseModel)

Number = Annotated[float, Field(allow_inf_nan=False)]
"""A finite float; an integer in the file is accepted, a string or a boolean is not."""
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
"""A finite float above zero."""
NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
"""A finite float, zero or above."""
Vector3 = Annotated[tuple[Number, Number, Number], Field(strict=False)]
"""Three finite floats."""

BRANCH = "|"
"""Begins the tags of alternatives, which pydantic puts into the path of a key and no file has."""


ONE, EACH = Tag(BRANCH + "one"), Tag(BRANCH + "each")
"""Tags of the two alternatives of a key that takes one value for all, or a list with one value each."""


def _merged(values: Any) -> Any:
    return values[0] if len(set(values)) == 1 else values


ALIKE = AfterValidator(_merged)
"""Makes a list of equal values the one value, so that two files of one machine compare as equal."""


def one_or_each(depth: int = 0) -> Discriminator:
    """Return what decides between `ONE` and `EACH`, for an annotation of both.

    Parameters
    ----------
    depth : int
        How many lists deep the one value is: 0 for a number, 1 for a pair of numbers.
    """

    def chosen(value: object) -> str:
        for _ in range(depth):
            value = value[0] if isinstance(value, list | tuple) and value else None
        return (EACH if isinstance(value, list | tuple) else ONE).tag

    return Discriminator(chosen)


UNITS = {
    *("m", "cm", "mm", "um", "nm", "in", "inch", "deg", "rad", "mrad", "s", "ms", "us", "min", "hz", "khz", "kg"),
    *("g", "n", "mm_s", "mm_s2", "mm_s3", "mm_min", "m_min", "m_s", "bit_s", "kbit_s", "c"),
}
"""Suffixes that count as units in an unknown key, to distinguish a wrong unit from a misspelt name."""

EXPECTED = {
    "missing": "this key",
    "float_type": "a number",
    "finite_number": "a finite number",
    "int_type": "a whole number",
    "string_type": "a text in quotes",
    "bool_type": "true or false",
    "list_type": "a list",
    "tuple_type": "a list",
    "dict_type": "a table",
    "model_type": "a table",
    "model_attributes_type": "a table",
    "greater_than": "a number > {gt:.10g}",
    "greater_than_equal": "a number >= {ge:.10g}",
    "less_than": "a number < {lt:.10g}",
    "less_than_equal": "a number <= {le:.10g}",
    "too_short": "a list of at least {min_length}, not {actual_length}",
    "too_long": "a list of at most {max_length}, not {actual_length}",
    "string_too_short": "a text that is not empty",
    "literal_error": "{expected}",
}
"""What was expected, by pydantic's error type; for a type not listed pydantic's own message is used."""


class StrictModel(BaseModel):
    """Part of a file: unknown keys and values of another type are errors; instances are immutable.

    pydantic compiles what validates it when the first instance is made: a command needs a third of all parts.
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, defer_build=True)


class FileModel(StrictModel):
    """A whole file; its path is not part of its content and is ignored by `==`."""

    _path: Path | None = PrivateAttr(default=None)

    @property
    def path(self) -> Path | None:
        """Path it was read from; None for a file made in memory or taken from a record."""
        return self._path

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and self.__dict__ == other.__dict__

    def __hash__(self) -> int:
        return hash(tuple(self.__dict__.values()))


class BadValueError(ValueError):
    """Raised in a validator; names the key below the model, its value and what was expected.

    Parameters
    ----------
    where : tuple of str and int
        Path below the model whose validator raises, for example ``("circle", 2, "mount")``.
    value : object
        The value found.
    expected : str
        Description of a valid value.
    """

    def __init__(self, where: Location, value: object, expected: str) -> None:
        super().__init__(f"{format_value(value)} (expected {expected})")
        self.where = where


def load_toml(path: Path | str, model: type[ModelT]) -> ModelT:
    """Read and validate a TOML file.

    Parameters
    ----------
    path : Path or str
        The file.
    model : type
        Pydantic model of the file's content.

    Returns
    -------
    instance of `model`

    Raises
    ------
    InputError
        One line naming file, key, value and what was expected.
    """
    instance = parse_toml(read_text(path), model, str(path))
    if isinstance(instance, FileModel):
        instance._path = Path(path)
    return instance


def read_text(path: Path | str) -> str:
    """Read a UTF-8 text file; raise `InputError` of one line where it is missing, unreadable or not UTF-8."""
    try:
        return Path(path).read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: byte {error.start} is not UTF-8 (expected UTF-8 text)") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None


def parse_toml(text: str, model: type[ModelT], origin: str) -> ModelT:
    """Parse and validate TOML text.

    Parameters
    ----------
    text : str
    model : type
        Pydantic model of the content.
    origin : str
        Name of the text in errors, for example its file.

    Raises
    ------
    InputError
        One line naming origin, key, value and what was expected.
    """
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{origin}: not valid TOML: {error}") from None
    except RecursionError:
        raise InputError(f"{origin}: not valid TOML: nested too deep (expected a few levels)") from None
    except ValueError:  # of Python's own limit on the digits of an integer
        raise InputError(f"{origin}: not valid TOML: a number with too many digits (expected a number)") from None
    _check_schema(data, model, origin)
    try:
        return model.model_validate(data)
    except ValidationError as error:
        raise InputError(f"{origin}: {validation_line(error, model)}") from None


def dump_toml(instance: BaseModel) -> str:
    """Return a model as TOML text under the file's own keys, unset and empty ones left out; floats read back alike."""
    content = instance.model_dump(by_alias=True, exclude_none=True)
    return toml_text({key: value for key, value in content.items() if value != {}})


def format_value(value: object) -> str:
    """Return a value as a TOML file shows it, shortened to 60 characters."""
    shown = f"{value:g}" if isinstance(value, float) and float(f"{value:g}") == value else repr(value)
    shown = {"True": "true", "False": "false"}.get(shown, shown)
    if isinstance(value, str) and value.isprintable():
        shown = f'"{value}"'
    return shown if len(shown) <= 60 else shown[:57] + "..."


def format_location(location: Location) -> str:
    """Return the path of a key as text: ``("circle", 2, "radius_mm")`` as ``circle[2].radius_mm``."""
    steps = (f"[{step}]" if isinstance(step, int) else f".{format_name(step)}" for step in location)
    return "".join(steps).lstrip(".")


def format_name(name: str) -> str:
    """Return the name of a key or column, escaped where it holds characters that are not printable."""
    return name if name.isprintable() else repr(name)


def nearest_key(unknown: str, known: list[str]) -> str:
    """Return the key probably meant: the same name with its unit, else the nearest spelling, else all known keys."""
    for key in known:
        if without_unit(key) == without_unit(unknown):
            return f"{key}: the unit is part of the key"
    close = difflib.get_close_matches(unknown, known, n=1, cutoff=0.6)
    return close[0] if close else "one of " + ", ".join(known)


def without_unit(key: str) -> str:
    """Return a key or column name without the unit it ends with: `radius` for `radius_mm` and for `radius_um`."""
    parts = key.lower().split("_")
    for first in range(1, len(parts)):
        if "_".join(parts[first:]) in UNITS:
            return "_".join(parts[:first])
    return "_".join(parts)


def _check_schema(data: Mapping[str, Any], model: type[BaseModel], origin: str) -> None:
    """Check the file's `schema` first: the keys of a file of another kind would only cause misleading errors."""
    expected = next((field.default for field in model.model_fields.values() if field.alias == "schema"), None)
    if expected is None or data.get("schema") == expected:
        return
    if "schema" not in data:
        raise InputError(f'{origin}: schema: missing (expected schema = "{expected}")')
    found = data["schema"]
    kind, _, version = str(found).partition("/")
    known_kind, _, known_version = expected.partition("/")
    later = kind == known_kind and version.isdecimal() and int(version) > int(known_version)
    note = "; this is a later version, which needs a later hexdbb" if later else ""
    raise InputError(f'{origin}: schema: {format_value(found)} (expected "{expected}"{note})')


def validation_line(error: ValidationError, model: type[BaseModel]) -> str:
    """Return the first error of a validation as one line: key, value and what was expected.

    Unknown keys come first, since a misspelt key also appears as a missing one.
    """
    details = error.errors(include_url=False)
    return _line(min(details, key=lambda detail: detail["type"] != "extra_forbidden"), model)


def _line(detail: ErrorDetails, model: type[BaseModel]) -> str:
    location = tuple(step for step in detail["loc"] if not str(step).startswith(BRANCH))
    value, context = detail["input"], detail.get("ctx", {})
    if detail["type"] == "extra_forbidden":
        expected = nearest_key(str(location[-1]), _keys_at(model, location[:-1]))
        return f"{format_location(location)}: unknown key (expected {expected})"
    if detail["type"] == "missing":
        what = "a value" if isinstance(location[-1], int) else "this key"
        return f"{format_location(location)}: missing (expected {what})"
    cause = context.get("error")
    if isinstance(cause, BadValueError):
        return f"{format_location((*location, *cause.where))}: {cause}"
    expected = EXPECTED[detail["type"]].format(**context) if detail["type"] in EXPECTED else detail["msg"]
    return f"{format_location(location)}: {format_value(value)} (expected {expected})"


def _keys_at(model: type[BaseModel], location: Location) -> list[str]:
    """Return the keys known at a location in the file, by following the model's annotations."""
    for step in location:
        fields = {field.alias or name: field for name, field in model.model_fields.items()}
        if isinstance(step, str) and step in fields:
            model = next(_models_in(fields[step].annotation), model)
    return [field.alias or name for name, field in model.model_fields.items()]


def _models_in(annotation: object) -> Iterator[type[BaseModel]]:
    """Yield the models named in an annotation such as ``tuple[Circle, ...]`` or ``CanSetup | None``."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for argument in get_args(annotation):
        yield from _models_in(argument)
