"""A machine driven along a path by compensated targets, and what its model says of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.compensation import make_compensation, path_targets
from hexdbb.kinematics import engine_machine, inverse
from hexdbb.machine import MachineFile, shipped_machine
from hexdbb.model import Model
from hexdbb.samples.loads import load_columns
from hexdbb.samples.memory import remembered_column
from hexdbb.samples.swing import derived_columns

Floats = NDArray[np.float64]

MACHINE = shipped_machine()
STEP_S = 0.004
RPY = np.array([0.05, -0.03, 0.1])
WARMING_K = 3.0
UP_DOWN_MM = 10.0
"""On a level path no leg changes its inclination."""


class Table:
    """Columns of samples by name, as effects take them."""

    def __init__(self, columns: Mapping[str, NDArray[Any]], machine: MachineFile = MACHINE) -> None:
        self.columns, self.machine = columns, machine

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self.columns[name]

    def __getattr__(self, name: str) -> NDArray[Any]:
        if name not in self.columns:
            raise AttributeError(name)
        return self.columns[name]

    def __len__(self) -> int:
        return len(self.columns["sliders_mm"])


def path(machine: MachineFile = MACHINE) -> Floats:
    """A lap and a half of 90 mm at 3000 mm/min in the middle of the machine's workspace, up and down; shape (n, 3)."""
    z_mm = 285.0 if machine.workspace is None else machine.workspace.centre_mm[2]
    angle = np.arange(0.0, 3.0 * np.pi, 50.0 / 90.0 * STEP_S)
    return np.column_stack([90.0 * np.cos(angle), 90.0 * np.sin(angle), z_mm + UP_DOWN_MM * np.sin(2.0 * angle)])


def table_of(sliders_mm: Floats, machine: MachineFile = MACHINE) -> tuple[Table, _core.Samples]:
    """Return samples of drives at these coordinates, with every column that follows from them."""
    count = len(sliders_mm)
    zeros = np.zeros(count, np.int32)
    state = {"time_s": STEP_S * np.arange(count), "sweep": zeros, "warming_k": np.full(count, WARMING_K)}
    # Less than a lap: of what was before the path a controller knows as little as a record of an arc.
    state["angle_rad"] = np.linspace(0.0, 6.0, count)
    set_up = _core.SetUp(cup_mm=np.zeros(3), ball_offset_mm=np.zeros(3), bar_length_mm=100.0)
    block = _core.Samples(sliders_mm=sliders_mm, set_up=zeros, mount=zeros, set_ups=[set_up], state=state)
    block.derive(engine_machine(machine))
    columns = {**block.state, "sliders_mm": sliders_mm, "set_up": zeros, "mount": zeros}
    columns |= derived_columns(machine, columns, [set_up])
    columns |= load_columns(columns["leg_force"], columns["slider_joint_angle_rad"])
    columns["leg_force.lagged@12"] = remembered_column(
        "lagged", 12.0, columns["leg_force"], state["time_s"], zeros, state["angle_rad"]
    )
    for rate in (0.2, 1925.0):
        columns[f"velocity_mm_s.turning@{rate:g}"] = remembered_column(
            "turning", rate, columns["velocity_mm_s"], state["time_s"], zeros, state["angle_rad"]
        )
    columns |= _turns(sliders_mm, machine)
    columns["warming_k"] = 5.0 * np.sin(np.arange(count))  # a range for functions of it; replaced below
    return Table(columns, machine), block


def _turns(sliders_mm: Floats, machine: MachineFile) -> dict[str, Floats]:
    turned = np.exp(2j * np.pi * sliders_mm / machine.sliders.screw_lead_mm)
    return {"screw_cos": turned.real, "screw_sin": turned.imag}


def nominal_table(machine: MachineFile = MACHINE) -> Table:
    """Return samples of the nominal machine on the path."""
    sliders_mm, status = inverse(machine, path(machine), RPY)
    assert not status.any()
    return table_of(sliders_mm, machine)[0]


def errors_mm(model: Model, targets_mm: Floats, commanded: Table | None = None) -> tuple[Floats, Table]:
    """Return the largest error of the platform's position and orientation on the model's machine, (n,), and samples.

    What the learned effect depends on is that of the drives, but for the sliders' positions that of `commanded` where
    it is given: a controller knows the commanded motion, without that of the correction itself.
    """
    table, block = table_of(targets_mm, model.machine)
    columns = {**(commanded or table).columns, "sliders_mm": targets_mm, **_turns(targets_mm, model.machine)}
    columns["warming_k"] = np.full(len(table), WARMING_K)
    driven = Table(columns, model.machine)
    engine = model.engine(lambda own, _: own.tabulated(driven))
    poses, status = _core.forward_table(engine, block)
    assert not status.any()
    reach_mm = 100.0  # from the reference point to a ball joint
    wanted = _core.rotation_from_rpy(*RPY).ravel()
    of_position = np.abs(poses[:, :3] - path(model.machine)).max(axis=1)
    return np.maximum(of_position, reach_mm * np.abs(poses[:, 3:] - wanted).max(axis=1)), driven


def targets_of(model: Model) -> Floats:
    data = make_compensation(model, max_correction_mm=2.0, reference_temperature_c=20.0)
    assert not data.left_out, data.left_out
    places_mm = path(model.machine)
    times_s = STEP_S * np.arange(len(places_mm))
    return path_targets(data, places_mm, RPY, time_s=times_s, temperature_c=20.0 + WARMING_K).sliders_mm
