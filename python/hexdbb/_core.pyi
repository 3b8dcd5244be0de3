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
    "CaptureHarmonics",
    "CompensationData",
    "CompensationError",
    "CompensationTable",
    "Compensator",
    "DesignSums",
    "EffectInfo",
    "FitResult",
    "FittedCircle",
    "Identifiability",
    "LONG_AGO",
    "Machine",
    "Model",
    "NormalEquations",
    "PORTS",
    "ParameterInfo",
    "Prediction",
    "RUN_UP_RAD",
    "Samples",
    "SetUp",
    "StateColumn",
    "TABLE_VARIABLES",
    "TabulatedEffect",
    "Zone",
    "autocorrelation_time",
    "chi_square_tail",
    "circular_hysteresis_mm",
    "compare_with_neighbours",
    "compensation_of",
    "design_sums",
    "deviation_at",
    "effect_info",
    "effect_names",
    "effect_pushes",
    "f_tail",
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
    "lap_differences",
    "largest_gap_rad",
    "least_squares_circle",
    "limit_threads",
    "log_normal_below",
    "make_path",
    "mean_paths",
    "minimum_zone",
    "normal_equations",
    "path_points_mm",
    "platform_joint",
    "port_sensitivity",
    "predict",
    "prior_sigmas",
    "project_out",
    "read_compensation",
    "require_machine",
    "rotation_from_rpy",
    "rpy_from_rotation",
    "rssr_angles",
    "run_up",
    "schur_complement",
    "state_columns",
    "status_name",
    "without_harmonics",
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
        leg_length_mm: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(6)"
        ],
        travel_min_mm: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(6)"
        ],
        travel_max_mm: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(6)"
        ],
        min_gap_mm: typing.SupportsFloat | typing.SupportsIndex,
        screw_lead_mm: typing.SupportsFloat | typing.SupportsIndex,
        moved_mass_kg: typing.SupportsFloat | typing.SupportsIndex,
        guideway_angle_rad: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
        ],
        joint_angle_rad: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
        ],
    ) -> None: ...
    @property
    def base_inradius_mm(self) -> float: ...
    @property
    def guideway_angle_rad(self) -> typing.Annotated[list[float], "FixedSize(3)"]: ...
    @property
    def joint_angle_rad(self) -> typing.Annotated[list[float], "FixedSize(3)"]: ...
    @property
    def joint_plane_height_mm(self) -> float: ...
    @property
    def leg_length_mm(self) -> typing.Annotated[list[float], "FixedSize(6)"]: ...
    @property
    def min_gap_mm(self) -> float: ...
    @property
    def moved_mass_kg(self) -> float: ...
    @property
    def platform_circumradius_mm(self) -> float: ...
    @property
    def screw_lead_mm(self) -> float: ...
    @property
    def travel_max_mm(self) -> typing.Annotated[list[float], "FixedSize(6)"]: ...
    @property
    def travel_min_mm(self) -> typing.Annotated[list[float], "FixedSize(6)"]: ...

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
    def ball_offset_mm(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        Centre ball, platform frame.
        """
    @property
    def bar_length_mm(self) -> float: ...
    @property
    def cup_mm(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        Tool cup, base frame.
        """

class StateColumn:
    """
    Description of one column of a sample's state.
    """
    @property
    def may_be_nan(self) -> bool:
        """
        Whether nan is a value: not measured.
        """
    @property
    def meaning(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def of(self) -> str:
        """
        What its numbers belong to: sample (shape (n,)), axis ((n, 3): x, y, z or roll, pitch, yaw), slider or leg ((n, 6)).
        """
    @property
    def unit(self) -> str: ...
    @property
    def width(self) -> int:
        """
        Numbers per sample: 1, 3 or 6.
        """

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
        Build samples.

        Parameters
        ----------
        sliders_mm : ndarray, shape (n, 6)
            As the encoders report them.
        set_up : ndarray of int, shape (n,)
            Index into set_ups.
        mount : ndarray of int, shape (n,)
            Fixing of the tool cup, from 0.
        set_ups : sequence of SetUp
        state : dict of str to ndarray, optional
            Columns by name (state_columns()), each of n rows; any may be missing.

        Raises
        ------
        ValueError
            An unknown column, a column of another length, an index out of range.
        """
    def column(self, name: str) -> typing.Any:
        """
        Return a column of the state, None where it is not known.
        """
    def derive(self, machine: Machine, columns: collections.abc.Sequence[str] = []) -> None:
        """
        Compute columns that follow from time_s, sweep, angle_rad and the sliders: those named, and what is found on
        the way; all where none is named.

        Raises
        ------
        ValueError
            Where time_s or sweep is missing, or time does not rise within a sweep, or a
            column is named that follows from no others.
        """
    def rows(self, which: typing.Annotated[numpy.typing.ArrayLike, numpy.int64]) -> Samples:
        """
        Return some rows, by index from 0; they remember their place in the table. ValueError where there is no such row.
        """
    @property
    def known(self) -> list[str]:
        """
        Names of the columns of the state that are known.
        """
    @property
    def mount(self) -> typing.Annotated[numpy.typing.NDArray[numpy.int32], "[m, 1]"]: ...
    @property
    def set_up(self) -> typing.Annotated[numpy.typing.NDArray[numpy.int32], "[m, 1]"]: ...
    @property
    def set_ups(self) -> list[SetUp]: ...
    @property
    def size(self) -> int: ...
    @property
    def sliders_mm(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 6]"]: ...
    @property
    def state(self) -> dict:
        """
        Columns of the state that are known, by name.
        """

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
        is_nonnegative: bool = False,
    ) -> None: ...
    @property
    def is_shape(self) -> bool:
        """
        Whether it pushes nothing by itself but shapes what the effect's other parameters push.
        """
    @property
    def limit(self) -> float:
        """
        Largest magnitude with a physical meaning; the fit's bound.
        """
    @property
    def lower(self) -> float:
        """
        Lower end of the physical domain.
        """
    @property
    def name(self) -> str: ...
    @property
    def prior_sigma(self) -> float:
        """
        Prior standard deviation.
        """
    @property
    def unit(self) -> str: ...
    @property
    def upper(self) -> float:
        """
        Upper end of the physical domain.
        """

class EffectInfo:
    """
    Description of an effect: physics, elements, parameters, ports.
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
        formula: str = "",
    ) -> None: ...
    @property
    def element_kind(self) -> str:
        """
        leg, slider, guideway, side, mount or machine.
        """
    @property
    def elements(self) -> list[str]:
        """
        Label of each element.
        """
    @property
    def formula(self) -> str:
        """
        What is pushed, as plain text.
        """
    @property
    def group(self) -> str:
        """
        geometry, set-up, places, catalogue or user.
        """
    @property
    def is_free_at_first(self) -> bool:
        """
        Whether a new model fits its values.
        """
    @property
    def is_set_up(self) -> bool:
        """
        Whether it belongs to the measurement, not to the machine.
        """
    @property
    def name(self) -> str: ...
    @property
    def needs(self) -> list[str]:
        """
        Columns of the samples' state it needs.
        """
    @property
    def parameters(self) -> list[ParameterInfo]:
        """
        Parameters of one element.
        """
    @property
    def physics(self) -> str:
        """
        One sentence.
        """
    @property
    def ports(self) -> list[str]:
        """
        Ports it may push, keys of PORTS.
        """
    @property
    def size(self) -> int:
        """
        Number of values: elements times parameters.
        """
    @property
    def source(self) -> str:
        """
        Thesis section, standard or paper.
        """

class TabulatedEffect:
    """
    An effect given as numbers: its value values[j] pushes port ports[j] by per_unit[:, j].
    """
    def __init__(
        self,
        info: EffectInfo,
        *,
        values: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        ports: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        per_unit: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    ) -> None:
        """
        Keep the numbers of an effect.

        Parameters
        ----------
        info : EffectInfo
        values : sequence of int
            Indices of the effect's values.
        ports : sequence of int
            Indices of ports, 0 to 54.
        per_unit : ndarray, shape (n, len(ports))
            Push per unit of the value, one row per sample, mm.

        Raises
        ------
        ValueError
            An index that does not exist, lengths that differ, a number not finite.
        """

class Model:
    """
    A machine and a list of effects with their values.
    """
    def __init__(self, machine: Machine) -> None: ...
    def add(self, name: str, mounts: typing.SupportsInt | typing.SupportsIndex) -> None:
        """
        Append an effect with all values zero. ValueError where no effect has that name.
        """
    def add_tabulated(self, effect: TabulatedEffect) -> None:
        """
        Append an effect given as numbers, with all values zero; models share its numbers.
        """
    @property
    def size(self) -> int: ...
    @property
    def values(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]: ...
    @values.setter
    def values(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...

class Prediction:
    """
    Predicted readings.
    """
    @property
    def first_failure(self) -> int:
        """
        First row without a solution, or -1.
        """
    @property
    def jacobian(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        d reading / d value, shape (n, size); empty unless asked for.
        """
    @property
    def reading_mm(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Shape (n,); 0 where there is no solution.
        """
    @property
    def status(self) -> typing.Annotated[numpy.typing.NDArray[numpy.int32], "[m, 1]"]:
        """
        Shape (n,); 0: solved, see status_name.
        """

class NormalEquations:
    """
    Normal equations of all readings, r = measured - predicted, J = d predicted / d value.
    """
    @property
    def failure(self) -> int:
        """
        First sample without a solution, or -1.
        """
    @property
    def gradient(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        J'r, shape (size,).
        """
    @property
    def information(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        J'J, shape (size, size).
        """
    @property
    def squared(self) -> float:
        """
        r'r, mm^2.
        """

class Identifiability:
    """
    Singular values and directions of a scaled Jacobian.
    """
    @property
    def condition(self) -> float:
        """
        Largest over smallest singular value within the rank.
        """
    @property
    def directions(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]: ...
    @property
    def identifiable(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        Directions within the rank, as columns.
        """
    @property
    def rank(self) -> int: ...
    @property
    def singular_values(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]: ...
    @property
    def unidentifiable(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        The other directions, as columns.
        """

class FitResult:
    """
    Estimates, covariance, rank, unidentifiable directions, termination.
    """
    @property
    def correlation(self) -> float:
        """
        Integrated autocorrelation time of the residuals, rows.
        """
    @property
    def covariance(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        Shape (size, size), prior included; 0 where not free.
        """
    @property
    def free_columns(self) -> list[int]:
        """
        Indices of the free values.
        """
    @property
    def iterations(self) -> int: ...
    @property
    def machine(self) -> Identifiability:
        """
        Identifiability of the machine's own free values.
        """
    @property
    def noise_mm(self) -> float:
        """
        The larger of the given noise and the RMS residual.
        """
    @property
    def residual_mm(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Measured minus predicted, shape (n,).
        """
    @property
    def rms_after_mm(self) -> float: ...
    @property
    def rms_before_mm(self) -> float: ...
    @property
    def termination(self) -> str:
        """
        Why the iteration ended.
        """
    @property
    def usable(self) -> bool: ...
    @property
    def values(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Shape (size,), engine units.
        """

class FittedCircle:
    """
    A circle in the plane of a path.
    """
    @property
    def centre_mm(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[2, 1]"]:
        """
        Shape (2,).
        """
    @property
    def radius_mm(self) -> float: ...

class Zone:
    """
    Two concentric circles that enclose a path.
    """
    @property
    def centre_mm(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[2, 1]"]:
        """
        Shape (2,).
        """
    @property
    def inner_mm(self) -> float: ...
    @property
    def outer_mm(self) -> float: ...
    @property
    def width_mm(self) -> float:
        """
        Radial separation of the two circles.
        """

class CaptureHarmonics:
    """
    The lowest harmonics of several captures, fitted to any number of columns.
    """
    def __init__(
        self,
        angle_rad: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
        captures: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.int64, "[m, 1]"]],
        highest: typing.SupportsInt | typing.SupportsIndex,
    ) -> None:
        """
        Prepare the harmonics.

        Parameters
        ----------
        angle_rad : ndarray, shape (n,)
        captures : list of ndarray of int
            Rows of each.
        highest : int

        Raises
        ------
        ValueError
            A row that is not there, or a negative number of harmonics.
        """
    def split(
        self, values: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]
    ) -> tuple[
        typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"],
        typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    ]:
        """
        Fit a column (n,) by mean and harmonics of each capture.

        Returns
        -------
        taken : ndarray, shape (captures, 1 + 2 highest)
            Components along orthonormal columns.
        left : ndarray, shape (n,)
            What is left; zero in rows of no capture.

        Raises
        ------
        ValueError
            A column of another length.
        """

class DesignSums:
    """
    Sums of a design W over each group of its rows, with a table T.
    """
    @property
    def cross(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        W'T of one group after another, shape (groups * columns, k).
        """
    @property
    def square(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        W'W of one group after another, shape (groups * columns, columns).
        """

class CompensationError(ValueError):
    pass

class CompensationTable:
    """
    A function in compensation data; see compensation_tables.hpp.
    """
    def __init__(
        self,
        *,
        effect: str,
        port: str,
        variable: str,
        times: str,
        period: typing.SupportsFloat | typing.SupportsIndex,
        pushes: collections.abc.Sequence[
            tuple[
                typing.SupportsInt | typing.SupportsIndex,
                typing.SupportsInt | typing.SupportsIndex,
                typing.SupportsFloat | typing.SupportsIndex,
            ]
        ],
        knots: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        values_mm: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
    ) -> None:
        """
        Make a table.

        Parameters
        ----------
        effect : str
        port : str
        variable, times : str
            Columns of the samples' state; empty where there is none.
        period : float
        pushes : sequence of (element, column, weight)
            Element and column of the port from 0.
        knots, values_mm : sequence of float
        """
    @property
    def effect(self) -> str: ...
    @property
    def knots(self) -> list[float]: ...
    @property
    def period(self) -> float: ...
    @property
    def port(self) -> str: ...
    @property
    def pushes(self) -> list[tuple[int, int, float]]:
        """
        Element and column of the port, both from 0, and weight.
        """
    @property
    def times(self) -> str: ...
    @property
    def values_mm(self) -> list[float]: ...
    @property
    def variable(self) -> str: ...

class CompensationData:
    """
    Compensation data that a controller loads; see compensation_file.hpp.
    """
    def header(self) -> str:
        """
        Return the same as constants of a C program.
        """
    def text(self) -> str:
        """
        Return the content of a compensation file.
        """
    @property
    def effects(self) -> list[str]:
        """
        Names of the effects that are corrected.
        """
    @property
    def left_out(self) -> list[tuple[str, str]]:
        """
        Effects that are not corrected, each with the reason.
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
    def record_sha256(self) -> list[str]:
        """
        Content hashes of the records that the model was fitted to.
        """
    @property
    def reference_temperature_c(self) -> float: ...
    @property
    def reversal_travel_mm(self) -> float: ...
    @property
    def tables(self) -> list[CompensationTable]:
        """
        Functions of learned and users' effects.
        """

class Compensator:
    """
    Slider targets under every effect of compensation data.
    """
    def __init__(self, data: CompensationData, source: str) -> None: ...
    def enable(self, on: bool) -> None:
        """
        Switch compensation off or on; it fades over the next 500 poses.
        """
    def poses_of(self, sliders_mm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 6]"]) -> tuple:
        """
        Compute the poses, (n, 12) as x, y, z in mm and the rotation row by row, and status (n,), of slider coordinates (n, 6).
        """
    def reset(self) -> None:
        """
        Forget the motion so far, as after homing.
        """
    def sliders_along(
        self,
        position_mm: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 3]", "flags.c_contiguous"],
        rpy_rad: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 3]", "flags.c_contiguous"],
        time_s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        temperature_c: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        travel_direction: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 6]"] | None = None,
        since_reversal_mm: tuple[
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 6]"],
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 6]"],
        ]
        | None = None,
    ) -> tuple:
        """
        Compute slider targets of poses in order of motion.

        Parameters
        ----------
        position_mm, rpy_rad : ndarray, shape (n, 3)
        time_s, temperature_c : ndarray, shape (n,)
            Temperature nan where not measured.
        travel_direction : ndarray, shape (n, 6), optional
            -1 to 1 per slider, where the motion to come is known; from the motion so far where not given.
        since_reversal_mm : pair of ndarray, shape (n, 6), optional
            Travel since a reversal, of motion down and of motion up; likewise.

        Returns
        -------
        sliders_mm, correction_mm : ndarray, shape (n, 6)
            A refused row has the last targets and, where a correction is too large, its size.
        status, slider : ndarray of int, shape (n,)
            Slider at fault from 0, or -1.
        """

def autocorrelation_time(
    residual: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    sweep: typing.Annotated[numpy.typing.ArrayLike, numpy.int32, "[m, 1]"],
) -> float:
    """
    Return the integrated autocorrelation time of a residual within sweeps, rows, at least 1 (Geyer 1992).

    Parameters
    ----------
    residual : ndarray, shape (n,)
    sweep : ndarray of int, shape (n,)
        Capture of each row.

    Raises
    ------
    ValueError
        Lengths that differ.
    """

def chi_square_tail(
    freedom: typing.SupportsFloat | typing.SupportsIndex, value: typing.SupportsFloat | typing.SupportsIndex
) -> float:
    """
    Return the probability that chi-square with these degrees of freedom (above 0) exceeds a value.
    """

def circular_hysteresis_mm(
    one: tuple[
        typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    ],
    other: tuple[
        typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    ],
) -> float:
    """
    Return the largest difference (mm) of two paths, angles and deviations each, at an angle that either has.
    """

def compare_with_neighbours(
    angle_rad: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    values: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    captures: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.int64, "[m, 1]"]],
    noise: typing.SupportsFloat | typing.SupportsIndex,
    *,
    neighbours: typing.SupportsInt | typing.SupportsIndex,
    dense_rad: typing.SupportsFloat | typing.SupportsIndex,
    doubtful: typing.SupportsFloat | typing.SupportsIndex,
    alone: typing.SupportsFloat | typing.SupportsIndex,
) -> tuple[
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    typing.Annotated[numpy.typing.NDArray[numpy.bool], "[m, 1]"],
]:
    """
    Compare values (n,) with their neighbours in a capture.

    Parameters
    ----------
    noise : float
        Least standard deviation of one value.
    neighbours : int
        Values to each side whose median is expected.
    dense_rad : float
        Median angle between values up to which neighbours say what to expect.
    doubtful : float
        Standard deviations from the middle of both neighbours from which a value is looked at.
    alone : float
        Standard deviations from the median of all neighbours beyond which it stands alone.

    Returns
    -------
    off : ndarray, shape (n,)
        Distance from the middle of both neighbours, in standard deviations; at the ends of a capture from lines
        through the values behind.
    alone : ndarray of bool, shape (n,)

    Raises
    ------
    ValueError
        Lengths that differ, or a row that is not there.
    """

def compensation_of(
    model: Model,
    *,
    name: str,
    model_sha256: str,
    max_correction_mm: typing.SupportsFloat | typing.SupportsIndex,
    reversal_travel_mm: typing.SupportsFloat | typing.SupportsIndex,
    reference_temperature_c: typing.SupportsFloat | typing.SupportsIndex,
    tables: collections.abc.Sequence[CompensationTable] = [],
    left_out: collections.abc.Sequence[tuple[str, str]] = [],
    record_sha256: collections.abc.Sequence[str] = [],
) -> CompensationData:
    """
    Select the effects of a model that a controller can correct, and state why the others are left out.

    Parameters
    ----------
    model : Model
    name : str
        Of the machine.
    model_sha256 : str
        Of the model file.
    max_correction_mm, reversal_travel_mm : float
    reference_temperature_c : float
        Temperature at which no growth is corrected; nan where not known.
    tables : sequence of CompensationTable, optional
        Of effects that the engine does not have.
    left_out : sequence of (str, str), optional
        Effects without a table, each with the reason.
    record_sha256 : sequence of str, optional
        Content hashes of the records the model was fitted to.
    """

def design_sums(
    place: typing.Annotated[numpy.typing.NDArray[numpy.int32], "[m, n]", "flags.c_contiguous"],
    weight: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.c_contiguous"],
    group: typing.Annotated[numpy.typing.NDArray[numpy.int32], "[m, 1]"],
    table: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.c_contiguous"],
    columns: typing.SupportsInt | typing.SupportsIndex,
    groups: typing.SupportsInt | typing.SupportsIndex,
) -> DesignSums:
    """
    Return the sums of a design and a table over each group of their rows.

    Parameters
    ----------
    place : ndarray of int32, shape (n, parts)
        Column of each entry of the design.
    weight : ndarray, shape (n, parts)
        The entries; those of one place add up.
    group : ndarray of int32, shape (n,)
        Group of each row, from 0; below 0 for none.
    table : ndarray, shape (n, k)
    columns : int
        Of the design.
    groups : int

    Raises
    ------
    ValueError
        Shapes that differ, or a place or group out of range.
    """

def deviation_at(
    angle_rad: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    deviation_mm: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    at_rad: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
    """
    Return a path's deviation (mm) at other angles (m,), by periodic linear interpolation.
    """

def effect_info(machine: Machine, mounts: typing.SupportsInt | typing.SupportsIndex, name: str) -> EffectInfo:
    """
    Return the description of an effect.

    Parameters
    ----------
    machine : Machine
    mounts : int
        Fixings of the tool cup the model distinguishes.
    name : str

    Raises
    ------
    ValueError
        Where no effect has that name, with the known names.
    """

def effect_names(group: str = "") -> list[str]:
    """
    Return the names of the effects of a group (geometry, set-up, places, catalogue), or of all.
    """

def effect_pushes(
    machine: Machine,
    mounts: typing.SupportsInt | typing.SupportsIndex,
    name: str,
    samples: Samples,
    values: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] | None = None,
) -> numpy.typing.NDArray[numpy.float64]:
    """
    Compute what an effect pushes at every port per unit of each of its values.

    Parameters
    ----------
    machine : Machine
    mounts : int
        Fixings of the tool cup the model distinguishes.
    name : str
    samples : Samples
    values : ndarray, shape (size,), optional
        Values at which the derivative is taken, engine units; zero where not given.

    Returns
    -------
    ndarray, shape (n, 55, size)
        d push / d value, mm per unit of the value; ports in the order of PORTS.

    Raises
    ------
    ValueError
        An unknown effect, values of another length, or samples without a column that the effect needs.
    """

def f_tail(
    numerator: typing.SupportsFloat | typing.SupportsIndex,
    denominator: typing.SupportsFloat | typing.SupportsIndex,
    value: typing.SupportsFloat | typing.SupportsIndex,
) -> float:
    """
    Return the probability that F with these degrees of freedom (above 0) exceeds a value.
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
    hypothesis: bool = False,
    from_minimum: bool = False,
    covariance: bool = True,
    prior_scale: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] = ...,
    starts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] = ...,
) -> FitResult:
    """
    Fit the free values of a model to readings.

    Parameters
    ----------
    model : Model
        Its values are the start.
    samples : Samples
    measured_mm : ndarray, shape (n,)
    noise_mm : float
        Standard deviation of one reading.
    free : sequence of bool, optional
        One per value; all are free where empty.
    max_iterations : int
    robust_mm : float
        Huber's limit; 0: least squares.
    sweep : ndarray of int, shape (n,), optional
        Capture of each sample, within which neighbours may be correlated.
    hypothesis : bool
        Full fit of a hypothesis: faster, its covariance to first order.
    from_minimum : bool
        Of a hypothesis: the start is the minimum of nearly the same readings.
    covariance : bool
        Whether covariance and correlation are wanted; else they are empty and 1.
    prior_scale : ndarray, shape (size,), optional
        Factors on the prior standard deviations.
    starts : ndarray, shape (size, k), optional
        Of a hypothesis: further starts of its free values; the lowest coarse minimum is refined.

    Raises
    ------
    ValueError
        Lengths that differ, no readings, nothing free, or a sample without a
        solution at the start.
    """

def forward_one(
    machine: Machine,
    sliders_mm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"],
    push: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[55, 1]"],
) -> tuple:
    """
    Solve the RSSR loops from home: position, rotation, residual_mm, iterations, status.
    """

def forward_six_one(
    machine: Machine,
    sliders_mm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"],
    push: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[55, 1]"],
) -> tuple:
    """
    Solve the six pose coordinates from home: position, rotation, residual_mm, iterations, status.
    """

def forward_table(
    model: Model, samples: Samples
) -> tuple[
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"],
    typing.Annotated[numpy.typing.NDArray[numpy.int32], "[m, 1]"],
]:
    """
    Compute the platform's poses, (n, 12) as x, y, z in mm and the rotation row by row, and their status, (n,).
    """

def guideway_axes(
    machine: Machine, guideway: typing.SupportsInt | typing.SupportsIndex
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 3]"]:
    """
    Return the local axes of guideway 0..2 as columns (3, 3): outward, -d, up. IndexError for any other guideway.
    """

def guideway_direction(
    machine: Machine, guideway: typing.SupportsInt | typing.SupportsIndex
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
    """
    Return d of guideway 0..2, unit vector (3,), base frame. IndexError for any other guideway.
    """

def guideway_midpoint(
    machine: Machine, guideway: typing.SupportsInt | typing.SupportsIndex
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
    """
    Return the point of guideway 0..2 nearest to the base centre, (3,) in mm, base frame. IndexError for any other guideway.
    """

def guideway_vertex(
    machine: Machine, guideway: typing.SupportsInt | typing.SupportsIndex
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
    """
    Return V of guideway 0..2, (3,) in mm, base frame. IndexError for any other guideway.
    """

def identifiability(
    scaled_jacobian: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    *,
    relative: typing.SupportsFloat | typing.SupportsIndex,
    absolute: typing.SupportsFloat | typing.SupportsIndex = 0.0,
) -> Identifiability:
    """
    Compute rank, condition and directions of a scaled Jacobian.

    The rank counts singular values above relative times the largest and above absolute.
    """

def inverse_table(
    machine: Machine,
    position_mm: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 3]", "flags.c_contiguous"],
    rpy_rad: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 3]", "flags.c_contiguous"],
) -> tuple:
    """
    Compute the slider coordinates of poses of the nominal machine.

    Parameters
    ----------
    machine : Machine
    position_mm : ndarray, shape (n, 3)
    rpy_rad : ndarray, shape (n, 3)

    Returns
    -------
    sliders_mm : ndarray, shape (n, 6)
    status : ndarray of int, shape (n,)
        0: reached; see status_name.
    leg : ndarray of int, shape (n,)
        Leg at fault from 0, or -1.
    """

def lap_differences(
    angle_rad: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    lap: typing.Annotated[numpy.typing.NDArray[numpy.int64], "[m, 1]"],
    values: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    captures: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.int64, "[m, 1]"]],
    highest: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
) -> list[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]]:
    """
    Return the differences of each two consecutive laps of captures at one angle, in units of one value's noise.

    Parameters
    ----------
    angle_rad, values : ndarray, shape (n,)
    lap : ndarray of int, shape (n,)
    captures : list of ndarray of int
        Rows of each.
    highest : list of int
        Harmonics that are removed from each capture's values first.

    Raises
    ------
    ValueError
        Lengths that differ, or a row that is not there.
    """

def largest_gap_rad(angle_rad: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]) -> float:
    """
    Return the largest arc without one of the angles (n,) of a path.
    """

def least_squares_circle(
    points_mm: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 2]", "flags.f_contiguous"],
) -> FittedCircle:
    """
    Fit the circle with the smallest sum of squared radial distances to points (n, 2).

    Raises
    ------
    ValueError
        Fewer than three points, or all on one line.
    """

def limit_threads(most: typing.SupportsInt | typing.SupportsIndex) -> None:
    """
    Limit the threads that fits use, in the whole process; 0: as many as cores. ValueError where negative.
    """

def log_normal_below(value: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    Return the logarithm of the probability that a standard normal value lies below a value.
    """

def make_path(
    angle_rad: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    deviation_mm: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
) -> tuple[
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
]:
    """
    Return angles (n,) in [0, 2 pi), rising, and the deviations at them. ValueError where lengths differ.
    """

def mean_paths(
    angle_rad: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    deviation_mm: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    turn: typing.Annotated[numpy.typing.NDArray[numpy.int64], "[m, 1]"],
    captures: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.int64, "[m, 1]"]],
    most_gap_rad: typing.SupportsFloat | typing.SupportsIndex,
) -> list[
    tuple[
        typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
        typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    ]
]:
    """
    Return angles and deviations, each (m,), of the mean of each capture's laps.

    Parameters
    ----------
    angle_rad, deviation_mm : ndarray, shape (n,)
    turn : ndarray of int, shape (n,)
        Lap of each sample.
    captures : list of ndarray of int
        Rows of each.
    most_gap_rad : float
        Laps with a longer arc without a sample do not count as long as another one does.

    Raises
    ------
    ValueError
        Lengths that differ, a row that is not there, or no samples.
    """

def minimum_zone(
    points_mm: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 2]", "flags.f_contiguous"],
) -> Zone:
    """
    Find the two concentric circles of smallest radial separation that enclose points (n, 2).

    Raises
    ------
    ValueError
        Fewer than four points at different angles, or all on one line.
    RuntimeError
        No zone was found within the iteration limit.
    """

def normal_equations(
    model: Model, samples: Samples, measured_mm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]
) -> NormalEquations:
    """
    Compute the normal equations for all values of a model in one pass. ValueError where lengths differ.
    """

def path_points_mm(
    angle_rad: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    deviation_mm: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    nominal_radius_mm: typing.SupportsFloat | typing.SupportsIndex,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 2]"]:
    """
    Return a path's places in its plane, (n, 2), about the nominal centre.
    """

def platform_joint(
    machine: Machine, guideway: typing.SupportsInt | typing.SupportsIndex
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
    """
    Return the nominal ball joint of guideway 0..2, (3,) in mm, platform frame. IndexError for any other guideway.
    """

def port_sensitivity(model: Model, samples: Samples) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    Compute d reading / d push at each port, (n, 55), mm per mm.
    """

def predict(model: Model, samples: Samples, want_jacobian: bool = False) -> Prediction:
    """
    Predict the readings of the ball bar under a model.
    """

def prior_sigmas(model: Model) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
    """
    Return the prior standard deviation of each value of a model, (size,).
    """

def project_out(
    jacobian: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    nuisance: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    Return the part of a Jacobian (n, k) that nuisance columns (n, m) cannot explain. ValueError where n differs.
    """

def read_compensation(path: str) -> CompensationData:
    """
    Read a compensation file. CompensationError where it is refused, with the reason.
    """

def require_machine(of_data: Machine, of_controller: Machine, source: str) -> None:
    """
    Raise CompensationError, naming the first dimension that differs, unless both machines are the same.
    """

def rotation_from_rpy(
    roll_rad: typing.SupportsFloat | typing.SupportsIndex,
    pitch_rad: typing.SupportsFloat | typing.SupportsIndex,
    yaw_rad: typing.SupportsFloat | typing.SupportsIndex,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 3]"]:
    """
    Compute Rz(yaw) Ry(pitch) Rx(roll), (3, 3), thesis (2.27).
    """

def rpy_from_rotation(
    rotation: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 3]"],
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
    """
    Compute roll, pitch and yaw in rad, (3,), for |pitch| below 90 deg; inverse of rotation_from_rpy.
    """

def rssr_angles(
    machine: Machine, sliders_mm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
    """
    Compute theta, delta, phi of the nominal machine, (3,) in rad, with the thesis' signs.
    """

def run_up(
    time_s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    angle_rad: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    run_up_rad: typing.SupportsFloat | typing.SupportsIndex = 0.7853981633974483,
) -> tuple[int, int, float]:
    """
    Return the rows of a sweep, from the first to before the last, that lie a lap behind the run-up to it, and the
    time of that lap, s; no rows where the sweep is less than a lap.

    Parameters
    ----------
    time_s, angle_rad : ndarray, shape (n,)
        Times, which rise, and polar angles, with or
        without their turns.
    run_up_rad : float

    Raises
    ------
    ValueError
        Where times and angles differ in number.
    """

def schur_complement(
    information: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
    wanted: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
    nuisance: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    Return J'J of the unknowns wanted, what the unknowns nuisance can explain projected out.

    Parameters
    ----------
    information : ndarray, shape (k, k)
        J'J of all unknowns.
    wanted, nuisance : sequence of int
        Indices of unknowns; redundant nuisance unknowns do no harm.

    Raises
    ------
    ValueError
        Where an index is out of range.
    """

def state_columns() -> list[StateColumn]:
    """
    Return every column of a sample's state, sliders_mm first: the one vocabulary of names and units.
    """

def status_name(code: typing.SupportsInt | typing.SupportsIndex) -> str:
    """
    Return what a status code of the kinematics means. ValueError for an unknown code.
    """

def without_harmonics(
    angle_rad: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    values: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    highest: typing.SupportsInt | typing.SupportsIndex,
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
    """
    Return values (n,) less their mean and their harmonics 1 to highest of angles (n,).
    """

CORRECTION_LIMIT: int = 6
LONG_AGO: float = 1000000.0
PORTS: dict = {
    "slider": (0, 6),
    "leg": (6, 6),
    "slider_joint": (12, 18),
    "platform_joint": (30, 18),
    "ball": (48, 3),
    "cup": (51, 3),
    "reading": (54, 1),
}
RUN_UP_RAD: float = 0.7853981633974483
TABLE_VARIABLES: tuple = (
    "sliders_mm",
    "velocity_mm_s",
    "travel_direction",
    "leg_force",
    "temperature_c",
    "warming_k",
    "slider_joint_angle_rad",
    "slider_joint_rate_rad_s",
    "slider_joint_direction",
    "platform_joint_angle_rad",
    "platform_joint_rate_rad_s",
    "swing_angle_rad",
    "swing_rate_rad_s",
    "since_reversal_mm",
    "acceleration_mm_s2",
    "leg_inclination_rad",
    "drive_load",
    "carriage_load",
)
