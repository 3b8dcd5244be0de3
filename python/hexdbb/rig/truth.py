"""The truth file: the errors of the simulated machine; and the seeded random machine used if no file is given.

Model: TOML of schema ``hexdbb.truth/1`` in µm, µrad, s and degrees, converted once to mm and rad. Error parameters have
the names and signs of the effects they belong to; those left out are zero.
Assumption: sizes of the random machine are those expected of a machine tool of this size: joints, guideways and offsets
50 µm, rotations 0.2 mrad, platform sides 30 µm, cup 0.1 mm (one standard deviation each), where `Spread` has no others.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import (
    Field,
    SerializeAsAny,
    SerializerFunctionWrapHandler,
    ValidationError,
    model_serializer,
    model_validator,
)

from hexdbb.files.validation import BadValueError, FileModel, NotNegative, Number, Positive, StrictModel, Vector3
from hexdbb.machine import MachineFile
from hexdbb.rig.geometry import Array, GeometryErrors, true_geometry
from hexdbb.rig.mechanisms import MECHANISMS, MechanismTable
from hexdbb.rig.plant import Machine, Point, SetupErrors

Vector6 = Annotated[tuple[Number, Number, Number, Number, Number, Number], Field(strict=False)]
Matrix3 = Annotated[tuple[Vector3, Vector3, Vector3], Field(strict=False)]
ZERO3, ZERO6 = (0.0,) * 3, (0.0,) * 6

RANDOM_MOUNTS = 8
"""Mounts for which a random machine has a cup error of its own: the shipped plans use one, proposed plans a few."""
RANDOM_SEED = 1
"""Seed of the random machine if neither file nor seed is given."""


class Geometry(StrictModel):
    """The 33 error parameters by effect."""

    leg_length_um: Vector6 = ZERO6
    slider_offset_um: Vector6 = ZERO6
    guideway_translation_um: Matrix3 = (ZERO3, ZERO3, ZERO3)
    """x, y, z of guideways 1 to 3, local axes."""
    guideway_rotation_xy_urad: Vector3 = ZERO3
    guideway_rotation_yz_urad: Vector3 = ZERO3
    guideway_rotation_centre_urad: Vector3 = ZERO3
    platform_side_um: Vector3 = ZERO3

    def errors(self) -> GeometryErrors:
        """Return the parameters in mm and rad."""
        return GeometryErrors(
            leg_length_mm=_scaled(self.leg_length_um, 1e-3),
            slider_offset_mm=_scaled(self.slider_offset_um, 1e-3),
            guideway_translation_mm=_scaled(self.guideway_translation_um, 1e-3),
            guideway_rotation_xy_rad=_scaled(self.guideway_rotation_xy_urad, 1e-6),
            guideway_rotation_yz_rad=_scaled(self.guideway_rotation_yz_urad, 1e-6),
            guideway_rotation_centre_rad=_scaled(self.guideway_rotation_centre_urad, 1e-6),
            platform_side_mm=_scaled(self.platform_side_um, 1e-3),
        )


class Setup(StrictModel):
    """Errors of the set-up, true minus nominal."""

    cup_error_um: Annotated[tuple[Vector3, ...], Field(strict=False)] = ()
    """One per mount, in order of mount id; a mount beyond the list has none."""
    ball_offset_error_um: Vector3 = ZERO3
    bar_length_error_um: Number = 0.0

    def errors(self) -> SetupErrors:
        """Return the errors in mm."""
        return SetupErrors(
            cup_mm={mount: _point(error) for mount, error in enumerate(self.cup_error_um)},
            ball_offset_mm=_point(self.ball_offset_error_um),
            bar_length_mm=self.bar_length_error_um * 1e-3,
        )


class GaugeTruth(StrictModel):
    """Noise, resolution and range of the gauge."""

    noise_um: NotNegative = 0.5
    resolution_um: NotNegative = 0.1
    range_um: Positive = 1000.0


class DriveTruth(StrictModel):
    """Dynamics of the six drives."""

    lag_s: Positive = 0.002
    velocity_feedforward: Annotated[float, Field(ge=0.0, le=1.0)] = 0.0


class Start(StrictModel):
    """Nominal pose at power-on; below the circle of the thesis, where no bar is mounted yet."""

    position_mm: Vector3 = (0.0, 0.0, 260.0)
    rpy_deg: Vector3 = ZERO3


class TruthFile(FileModel):
    """A validated truth file."""

    schema_id: Literal["hexdbb.truth/1"] = Field(default="hexdbb.truth/1", alias="schema")
    seed: Annotated[int, Field(ge=0)] = RANDOM_SEED
    """Seed of the gauge's noise."""
    geometry: Geometry = Geometry()
    setup: Setup = Setup()
    gauge: GaugeTruth = GaugeTruth()
    drive: DriveTruth = DriveTruth()
    start: Start = Start()
    mechanism: Annotated[tuple[SerializeAsAny[MechanismTable], ...], Field(strict=False)] = ()
    """Mechanisms in the order in which they act."""

    def true_machine(self, machine: MachineFile) -> Machine:
        """Return the true machine of a nominal one, with its mechanisms at rest."""
        return Machine(
            true_geometry(machine, self.geometry.errors()),
            self.setup.errors(),
            [table.start(machine) for table in self.mechanism],
        )

    @model_serializer(mode="wrap")
    def _without_empty_list(self, to_dict: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """Leave out an empty list, so that `[[mechanism]]` can be appended to the file."""
        return {key: value for key, value in to_dict(self).items() if key != "mechanism" or value}

    @model_validator(mode="before")
    @classmethod
    def _mechanisms_by_kind(cls, data: Any) -> Any:
        if not isinstance(data, Mapping) or not isinstance(data.get("mechanism"), list):
            return data
        return {**data, "mechanism": [_mechanism(k, item) for k, item in enumerate(data["mechanism"])]}


class Spread(StrictModel):
    """Standard deviations of the errors of a random machine and of its set-up."""

    length_um: NotNegative = 50.0
    """Lengths of legs, offsets of sliders, displacements of guideways."""
    rotation_urad: NotNegative = 200.0
    """Rotations of guideways."""
    platform_side_um: NotNegative = 30.0
    """Sides of the platform's triangle."""
    cup_um: NotNegative = 100.0
    """Position of the cup along each axis, for each mount."""
    ball_um: NotNegative = 30.0
    """Position of the centre ball on the platform along each axis."""


def random_truth(seed: int, spread: Spread | None = None) -> TruthFile:
    """Return a random machine, its errors drawn with a spread; equal seeds and spreads give equal machines."""
    draw = np.random.default_rng(seed)
    spread = Spread() if spread is None else spread

    def some(sigma: float, *shape: int) -> Any:
        return np.round(draw.normal(0.0, sigma, shape), 3).tolist()

    return TruthFile(
        seed=seed,
        geometry=Geometry(
            leg_length_um=some(spread.length_um, 6),
            slider_offset_um=some(spread.length_um, 6),
            guideway_translation_um=some(spread.length_um, 3, 3),
            guideway_rotation_xy_urad=some(spread.rotation_urad, 3),
            guideway_rotation_yz_urad=some(spread.rotation_urad, 3),
            guideway_rotation_centre_urad=some(spread.rotation_urad, 3),
            platform_side_um=some(spread.platform_side_um, 3),
        ),
        setup=Setup(cup_error_um=some(spread.cup_um, RANDOM_MOUNTS, 3), ball_offset_error_um=some(spread.ball_um, 3)),
    )


def _mechanism(position: int, item: object) -> object:
    if isinstance(item, MechanismTable) or not isinstance(item, Mapping):
        return item
    kind = item.get("kind")
    table = MECHANISMS.get(kind) if isinstance(kind, str) else None
    if table is None:
        raise BadValueError(("mechanism", position, "kind"), kind, "one of " + ", ".join(MECHANISMS))
    try:
        return table.model_validate(item)
    except ValidationError as error:
        first = error.errors()[0]
        where = ("mechanism", position, *first["loc"])
        raise BadValueError(where, first["input"], f"{kind}: {first['msg']}") from None


def _scaled(values: object, factor: float) -> Array:
    return np.asarray(values, dtype=float) * factor


def _point(values_um: tuple[float, float, float]) -> Point:
    x, y, z = values_um
    return x * 1e-3, y * 1e-3, z * 1e-3
