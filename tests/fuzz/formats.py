"""Every format that hexdbb reads: a good file, how it is damaged, and how it is read.

Another format is another entry of `FORMATS`.
"""

from __future__ import annotations

import random
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import canopen
import numpy as np
from tests.fuzz import frames
from tests.fuzz.mutations import BINARY, TEXT, TOML, Mutation, damaged

from hexdbb.capture.sdo import RemoteDevice
from hexdbb.compensation import make_compensation, read_compensation
from hexdbb.compensation.csv_tables import read_poses
from hexdbb.files.validation import load_toml
from hexdbb.kinematics import inverse
from hexdbb.machine import load_machine, shipped, shipped_machine
from hexdbb.model import load_model, new_model, save_model
from hexdbb.plan import load_plan
from hexdbb.record import SLIDER_COLUMNS, TARGET_COLUMNS, Journal, Record, read_record, recover, write_record
from hexdbb.rig.bus import Rig
from hexdbb.rig.truth import TruthFile, random_truth

SAMPLES = 40


@dataclass(frozen=True)
class Format:
    """One format.

    Attributes
    ----------
    name : str
    file : str
        Name of the file that is damaged, among the `good_files`.
    mutations : list
    read : callable
        Reads the file as the product does; called with its path.
    weight : int
        Share of the inputs.
    sealed : callable
        Makes a damaged file pass checks that would refuse it at once, such as a checksum.
    """

    name: str
    file: str
    mutations: list[Mutation]
    read: Callable[[Path], object]
    weight: int = 10
    sealed: Callable[[bytes], bytes] = bytes

    @property
    def slug(self) -> str:
        """Name of the format in file names."""
        return self.name.replace(" ", "-").replace(",", "")

    def input(self, good: bytes, rng: random.Random) -> bytes:
        """Return a damaged file."""
        return self.sealed(damaged(good, self.mutations, rng))


def resealed(data: bytes) -> bytes:
    """Return a compensation file with the checksum of its text, as another program would write it."""
    above = data[: data.rfind(b"[check]\n")] if b"[check]\n" in data else data
    return above + b'[check]\ncrc32 = "%08x"\n' % zlib.crc32(above)


def _model(path: Path) -> object:
    return load_model(path).engine()


def _rig_truth(path: Path) -> object:
    return load_toml(path, TruthFile).true_machine(shipped_machine())


def _capture_eds(path: Path) -> object:
    device = RemoteDevice(canopen.Network(), 1, "slider 1", path)
    return [device.default(index, 0) for index in (0x1000, 0x1006, 0x6040, 0x6041, 0x607A) if device.has(index, 0)]


def _rig_eds(path: Path) -> object:
    """Start the rig with a machine file whose first drive has this EDS, as ``hexdbb rig --machine`` does."""
    machine = shipped_machine()
    drives = (str(path), *machine.can_setup.drive_eds[1:])
    setup = machine.can_setup.model_copy(update={"drive_eds": drives})
    return Rig(machine.model_copy(update={"can": setup}), random_truth(1))


FORMATS: list[Format] = [
    Format("machine file", "machine.toml", TOML, load_machine),
    Format("plan", "plan.toml", TOML, lambda path: load_plan(path).machine_file()),
    Format("measurement of the text form", "text.toml", TOML, lambda path: read_record(path.with_suffix(".csv"))),
    Format("samples of the text form", "text.csv", TEXT, read_record),
    Format("record", "run.parquet", BINARY, read_record),
    Format("journal", "run.parquet.journal", BINARY, recover),
    Format("model", "model.toml", TOML, _model),
    Format("compensation file", "a.hexcomp", TEXT, read_compensation),
    Format("compensation file, sealed", "a.hexcomp", TEXT, read_compensation, sealed=resealed),
    Format("path of poses", "poses.csv", TEXT, read_poses),
    Format("truth file", "truth.toml", TOML, _rig_truth),
    Format("EDS, controller", "drive.eds", TEXT, _capture_eds, weight=4),
    Format("EDS, rig", "drive.eds", TEXT, _rig_eds, weight=1),
    Format("frames", "frames.txt", TEXT, frames.read, weight=20),
]


def good_files(folder: Path) -> None:
    """Write a good file of every format into a folder."""
    machine, plan = shipped("sp120.toml"), load_plan("thesis")
    (folder / "machine.toml").write_bytes(machine.read_bytes())
    (folder / "plan.toml").write_bytes(shipped("plans", "thesis.toml").read_bytes())
    (folder / "drive.eds").write_bytes(shipped("eds", "hexglider_drive.eds").read_bytes())
    (folder / "frames.txt").write_text(frames.GOOD)
    (folder / "truth.toml").write_text(TRUTH)
    (folder / "poses.csv").write_text(
        "x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg\n"
        + "".join(f"{x / 7:.4f},{x / 3:.4f},{280 + x / 10:.3f},0,0.5,0\n" for x in range(20))
    )
    model = new_model(shipped_machine(), ["leg_length", "cup_position", "guideway_translation"])
    save_model(model, folder / "model.toml")
    (folder / "a.hexcomp").write_text(make_compensation(model).text(), encoding="utf-8")
    record = _record()
    write_record(record, folder / "run.parquet")
    write_record(record, folder / "text.csv")
    _write_journal(record, folder)
    assert plan.circles == record.circles


def _record() -> Record:
    """Return a record of two short sweeps whose sliders stand where its circle is."""
    plan = load_plan("thesis")
    (circle,), (mount,) = plan.circles, plan.mounts
    angle_deg = np.linspace(0.0, 720.0, SAMPLES)
    sliders_mm, _ = inverse(
        plan.machine_file(), circle.poses(np.radians(angle_deg), mount.cup_mm), circle.platform_rpy_rad
    )
    second = np.arange(SAMPLES) >= SAMPLES // 2
    named = {name: sliders_mm[:, k] for k, name in enumerate(SLIDER_COLUMNS)}
    columns = {
        "t_s": np.arange(SAMPLES) * 0.004,
        "circle": np.zeros(SAMPLES),
        "sweep": second.astype(float),
        "direction": np.where(second, 1.0, -1.0),
        "lap": np.zeros(SAMPLES),
        "angle_deg": angle_deg,
        "feed_mm_min": np.full(SAMPLES, 753.98),
        **named,
        "reading_um": np.sin(angle_deg),
        **dict(zip(TARGET_COLUMNS, named.values(), strict=True)),
        "status": np.zeros(SAMPLES),
    }
    return Record(columns, plan.gauge, plan.mounts, plan.circles, plan.machine_file(), {"can": {"bus": "none"}})


def _write_journal(record: Record, folder: Path) -> None:
    parts = {"gauge": record.gauge, "mounts": record.mounts, "circles": record.circles, "machine": record.machine}
    (folder / "journal").mkdir()
    with Journal(folder / "journal" / "run.parquet", **parts) as journal:  # type: ignore[arg-type]
        journal.append(record.columns)
    (folder / "journal" / "run.parquet.journal").rename(folder / "run.parquet.journal")
    (folder / "journal").rmdir()


def _matrix(rows: int) -> str:
    return "[" + ", ".join("[1.5, -2, 0.25]" for _ in range(rows)) + "]"


TRUTH = f"""schema = "hexdbb.truth/1"
seed = 4
[geometry]
leg_length_um = [60, -40, 90, -120, 30, 50]
guideway_translation_um = {_matrix(3)}
[setup]
cup_error_um = [[90, -60, 40]]
bar_length_error_um = 3.0
[gauge]
noise_um = 0.5
[drive]
lag_s = 0.002
[start]
position_mm = [0.0, 0.0, 260.0]
[[mechanism]]
kind = "backlash"
slider = 1
width_um = 8.0
[[mechanism]]
kind = "leg_thermal"
growth_um = 15.0
time_constant_s = 900.0
"""
