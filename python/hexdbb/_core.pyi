# Made by `make stubs` from the compiled module; not to be edited.
"""
The engine of hexdbb: kinematics, effects, prediction, diagnosis. Units: mm, rad, s, N; indices from 0.
"""

from __future__ import annotations

import collections.abc
import typing

import numpy
import numpy.typing

__all__: list[str] = [
    "CORRECTION_LIMIT",
    "CompensationData",
    "CompensationError",
    "Compensator",
    "EffectInfo",
    "FitResult",
    "Identifiability",
    "Machine",
    "Model",
    "NormalEquations",
    "PORTS",
    "ParameterInfo",
    "Prediction",
    "Samples",
    "SetUp",
    "compensation_of",
    "effect_info",
    "effect_names",
    "expected_sizes",
    "fit",
    "forward_one",
    "forward_six_one",
    "forward_table",
    "guideway_axes",
    "guideway_direction",
    "guideway_midpoint",
    "guideway_vertex",
    "identifiability",
    "inverse_table",
    "normal_equations",
    "platform_joint",
    "port_sensitivity",
    "predict",
    "project_out",
    "read_compensation",
    "require_machine",
    "rotation_from_rpy",
    "rpy_from_rotation",
    "rssr_angles",
    "status_name",
]

class Machine:
    """
    Nominal dimensions of a HexGlider.
    """
    def __init__(
        self,
        *,
        base_inradius_mm: typing.SupportsFloat | typing.SupportsIndex,
        platform_circumradius_mm: typing.SupportsFloat | typing.SupportsIndex,
        joint_plane_height_mm: typing.SupportsFloat | typing.SupportsIndex,
        leg_length_mm: typing.SupportsFloat | typing.SupportsIndex,
        travel_min_mm: typing.SupportsFloat | typing.SupportsIndex,
        travel_max_mm: typing.SupportsFloat | typing.SupportsIndex,
        min_gap_mm: typing.SupportsFloat | typing.SupportsIndex,
        screw_lead_mm: typing.SupportsFloat | typing.SupportsIndex,
        moved_mass_kg: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...
    @property
    def base_inradius_mm(self) -> float: ...
    @property
    def joint_plane_height_mm(self) -> float: ...
    @property
    def leg_length_mm(self) -> float: ...
    @property
    def min_gap_mm(self) -> float: ...
    @property
    def moved_mass_kg(self) -> float: ...
    @property
    def platform_circumradius_mm(self) -> float: ...
    @property
    def screw_lead_mm(self) -> float: ...
    @property
    def travel_max_mm(self) -> float: ...
    @property
    def travel_min_mm(self) -> float: ...

class ParameterInfo:
    """
    One parameter of an effect, in the engine's units.
    """
    def __init__(
        self,
        *,
        name: str,
        unit: str,
        prior_sigma: typing.SupportsFloat | typing.SupportsIndex,
        limit: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...
    @property
    def is_shape(self) -> bool: ...
    @property
    def limit(self) -> float: ...
    @property
    def name(self) -> str: ...
    @property
    def prior_sigma(self) -> float: ...
    @property
    def unit(self) -> str: ...

class EffectInfo:
    """
    What an effect is: physics, source, elements, parameters, ports.
    """
    def __init__(
        self,
        *,
        name: str,
        physics: str,
        source: str,
        element_kind: str,
        elements: collections.abc.Sequence[str],
        parameters: collections.abc.Sequence[ParameterInfo],
        ports: collections.abc.Sequence[str],
    ) -> None: ...
    @property
    def element_kind(self) -> str: ...
    @property
    def elements(self) -> list[str]: ...
    @property
    def group(self) -> str: ...
    @property
    def is_set_up(self) -> bool: ...
    @property
    def name(self) -> str: ...
    @property
    def needs(self) -> list[str]: ...
    @property
    def parameters(self) -> list[ParameterInfo]: ...
    @property
    def physics(self) -> str: ...
    @property
    def ports(self) -> list[str]: ...
    @property
    def size(self) -> int: ...
    @property
    def source(self) -> str: ...

class SetUp:
    """
    One fixing of the bar: nominal cup, ball and bar length.
    """
    def __init__(
        self,
        *,
        cup_mm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        ball_offset_mm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        bar_length_mm: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...
    @property
    def ball_offset_mm(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]: ...
    @property
    def bar_length_mm(self) -> float: ...
    @property
    def cup_mm(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]: ...

class Samples:
    """
    Samples of a record, one row each, with what is known of their state.
    """
    def __init__(
        self,
        *,
        sliders_mm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 6]"],
        set_up: typing.Annotated[numpy.typing.ArrayLike, numpy.int32, "[m, 1]"],
        mount: typing.Annotated[numpy.typing.ArrayLike, numpy.int32, "[m, 1]"],
        set_ups: collections.abc.Sequence[SetUp],
        state: dict = {},
    ) -> None:
        """
        `state`: columns by name; any may be missing, an effect that needs one says so.
        """
    def derive(self, machine: Machine) -> None:
        """
        Fill what follows from time_s, sweep and the sliders: motion, leg forces, nominal readings.
        """
    def rows(self, which: typing.Annotated[numpy.typing.ArrayLike, numpy.int64]) -> Samples:
        """
        Some rows; what is tabulated for the whole stays right for the part.
        """
    @property
    def size(self) -> int: ...
    @property
    def sliders_mm(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 6]"]: ...
    @property
    def state(self) -> dict:
        """
        Columns of the state that are known, by name.
        """

class Model:
    """
    A machine and a list of effects with their values.
    """
    def __init__(self, machine: Machine) -> None: ...
    def add(self, name: str, mounts: typing.SupportsInt | typing.SupportsIndex) -> None:
        """
        Append the effect of that name with all values zero.
        """
    def add_tabulated(
        self,
        info: EffectInfo,
        *,
        values: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ports: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        per_unit: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    ) -> None:
        """
        Append an effect whose value values[j] pushes port ports[j] by per_unit[:, j], a row a sample.
        """
    @property
    def size(self) -> int: ...
    @property
    def values(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]: ...
    @values.setter
    def values(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...

class Prediction:
    """
    Readings in mm, status, Jacobian (samples x values).
    """
    @property
    def first_failure(self) -> int: ...
    @property
    def jacobian(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]: ...
    @property
    def reading_mm(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]: ...
    @property
    def status(self) -> typing.Annotated[numpy.typing.NDArray[numpy.int32], "[m, 1]"]: ...

class NormalEquations:
    """
    J'J, J'r and r'r of all readings, r = measured - predicted.
    """
    @property
    def failure(self) -> int: ...
    @property
    def gradient(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]: ...
    @property
    def information(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]: ...
    @property
    def squared(self) -> float: ...

class Identifiability:
    """
    Singular values and directions of a scaled Jacobian.
    """
    @property
    def condition(self) -> float: ...
    @property
    def directions(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]: ...
    @property
    def identifiable(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]: ...
    @property
    def rank(self) -> int: ...
    @property
    def singular_values(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]: ...
    @property
    def unidentifiable(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]: ...

class FitResult:
    """
    Estimates, covariance, rank, unidentifiable directions, termination.
    """
    @property
    def correlation(self) -> float: ...
    @property
    def covariance(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]: ...
    @property
    def free_columns(self) -> list[int]: ...
    @property
    def iterations(self) -> int: ...
    @property
    def machine(self) -> Identifiability: ...
    @property
    def noise_mm(self) -> float: ...
    @property
    def residual_mm(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]: ...
    @property
    def rms_after_mm(self) -> float: ...
    @property
    def rms_before_mm(self) -> float: ...
    @property
    def termination(self) -> str: ...
    @property
    def usable(self) -> bool: ...
    @property
    def values(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]: ...

class CompensationError(ValueError):
    pass

class CompensationData:
    """
    What a controller loads; see compensation_file.hpp.
    """
    def header(self) -> str:
        """
        The same as constants of a C program.
        """
    def text(self) -> str:
        """
        Content of a compensation file.
        """
    @property
    def effects(self) -> list[str]:
        """
        Names of the effects it corrects.
        """
    @property
    def left_out(self) -> list[tuple[str, str]]:
        """
        Effects it does not correct, each with the reason.
        """
    @property
    def machine(self) -> Machine: ...
    @property
    def max_correction_mm(self) -> float: ...
    @property
    def model_sha256(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def reference_temperature_c(self) -> float: ...
    @property
    def reversal_travel_mm(self) -> float: ...

class Compensator:
    """
    Slider targets under every effect of compensation data.
    """
    def __init__(self, data: CompensationData, source: str) -> None: ...
    def enable(self, on: bool) -> None:
        """
        Off or on; it fades over the next 500 poses.
        """
    def poses_of(self, sliders_mm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 6]"]) -> tuple:
        """
        Poses (n, 12) as x, y, z and the rotation row by row, status (n,), of rows of slider coordinates.
        """
    def reset(self) -> None:
        """
        Forget how the machine moved before.
        """
    def sliders_along(
        self,
        position_mm: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 3]", "flags.c_contiguous"],
        rpy_rad: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 3]", "flags.c_contiguous"],
        time_s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        temperature_c: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        side: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 6]"] | None = None,
    ) -> tuple:
        """
        Targets, corrections (n, 6) in mm, status, slider at fault (n,) of poses in order of motion.

        A row refused has the last targets, and where a correction is too large, its size.
        side (n, 6), -1 .. 1, is where each slider comes from, if the motion to come is known;
        without it the sides follow from the motion so far.
        """

def compensation_of(
    model: Model,
    *,
    name: str,
    model_sha256: str,
    max_correction_mm: typing.SupportsFloat | typing.SupportsIndex,
    reversal_travel_mm: typing.SupportsFloat | typing.SupportsIndex,
    reference_temperature_c: typing.SupportsFloat | typing.SupportsIndex,
    unknown: collections.abc.Sequence[str] = [],
) -> CompensationData:
    """
    What of a model a controller can correct, and why the rest not.

    reference_temperature_c: nan where not known; unknown: effects of the model that the engine does not have.
    """

def effect_info(machine: Machine, mounts: typing.SupportsInt | typing.SupportsIndex, name: str) -> EffectInfo:
    """
    The effect of that name; ValueError where there is none.
    """

def effect_names(group: str = "") -> list[str]:
    """
    Names of the effects of a group (geometry, set-up, catalogue), or of all.
    """

def expected_sizes(model: Model) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
    """
    Prior sigma of each value of a model.
    """

def fit(
    model: Model,
    samples: Samples,
    measured_mm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    *,
    noise_mm: typing.SupportsFloat | typing.SupportsIndex,
    free: collections.abc.Sequence[bool] = [],
    max_iterations: typing.SupportsInt | typing.SupportsIndex = 50,
    robust_mm: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    sweep: typing.Annotated[numpy.typing.ArrayLike, numpy.int32, "[m, 1]"] = ...,
    judging: bool = False,
) -> FitResult:
    """
    Fit the free values of a model to readings.
    """

def forward_one(
    machine: Machine,
    sliders_mm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"],
    push: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[55, 1]"],
) -> tuple:
    """
    RSSR solution from home: position, rotation, residual_mm, iterations, status.
    """

def forward_six_one(
    machine: Machine,
    sliders_mm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"],
    push: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[55, 1]"],
) -> tuple:
    """
    Six-coordinate solution from home: position, rotation, residual_mm, iterations, status.
    """

def forward_table(
    model: Model, samples: Samples
) -> tuple[
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"],
    typing.Annotated[numpy.typing.NDArray[numpy.int32], "[m, 1]"],
]:
    """
    Poses (n, 12) as x, y, z and the rotation row by row; status (n,).
    """

def guideway_axes(
    guideway: typing.SupportsInt | typing.SupportsIndex,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 3]"]:
    """
    Local axes of guideway 0..2 as columns: outward, -d, up.
    """

def guideway_direction(
    guideway: typing.SupportsInt | typing.SupportsIndex,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
    """
    d of guideway 0..2, unit vector.
    """

def guideway_midpoint(
    machine: Machine, guideway: typing.SupportsInt | typing.SupportsIndex
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
    """
    Point of guideway 0..2 nearest to the base centre, mm, base frame.
    """

def guideway_vertex(
    machine: Machine, guideway: typing.SupportsInt | typing.SupportsIndex
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
    """
    V of guideway 0..2, mm, base frame.
    """

def identifiability(
    scaled_jacobian: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    *,
    relative: typing.SupportsFloat | typing.SupportsIndex,
    absolute: typing.SupportsFloat | typing.SupportsIndex = 0.0,
) -> Identifiability:
    """
    Rank, condition and directions of a scaled Jacobian.
    """

def inverse_table(
    machine: Machine,
    position_mm: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 3]", "flags.c_contiguous"],
    rpy_rad: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 3]", "flags.c_contiguous"],
) -> tuple:
    """
    Slider coordinates (n, 6) in mm, status (n,) and leg at fault (n,) of nominal poses.
    """

def normal_equations(
    model: Model, samples: Samples, measured_mm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]
) -> NormalEquations:
    """
    Normal equations for all values of a model, in one pass.
    """

def platform_joint(
    machine: Machine, guideway: typing.SupportsInt | typing.SupportsIndex
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
    """
    Nominal ball joint 0..2, mm, platform frame.
    """

def port_sensitivity(model: Model, samples: Samples) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    d reading / d push at each port, (n, 55), mm per mm.
    """

def predict(model: Model, samples: Samples, want_jacobian: bool = False) -> Prediction:
    """
    What the ball bar reads under a model.
    """

def project_out(
    jacobian: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    nuisance: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    The part of a Jacobian that nuisance columns cannot explain.
    """

def read_compensation(path: str) -> CompensationData:
    """
    Read a compensation file; CompensationError says why it is refused.
    """

def require_machine(of_data: Machine, of_controller: Machine, source: str) -> None:
    """
    CompensationError naming the first dimension that differs.
    """

def rotation_from_rpy(
    roll_rad: typing.SupportsFloat | typing.SupportsIndex,
    pitch_rad: typing.SupportsFloat | typing.SupportsIndex,
    yaw_rad: typing.SupportsFloat | typing.SupportsIndex,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 3]"]:
    """
    Rz(yaw) Ry(pitch) Rx(roll), thesis (2.27).
    """

def rpy_from_rotation(
    rotation: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 3]"],
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
    """
    (roll, pitch, yaw) in rad.
    """

def rssr_angles(
    machine: Machine, sliders_mm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
    """
    theta, delta, phi of the nominal machine in rad, as the thesis counts them.
    """

def status_name(code: typing.SupportsInt | typing.SupportsIndex) -> str:
    """
    What a status code of the kinematics means.
    """

CORRECTION_LIMIT: int = 6
PORTS: dict = {
    "slider": (0, 6),
    "leg": (6, 6),
    "slider_joint": (12, 18),
    "platform_joint": (30, 18),
    "ball": (48, 3),
    "cup": (51, 3),
    "reading": (54, 1),
}
