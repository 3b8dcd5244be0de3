"""The rig: nodes, machine and faults on one bus, clocked by SYNC.

Model of one SYNC: every node samples its values and sends its TPDO; all frames leave together; then every drive takes
over its last target and moves for one communication cycle, and the true machine follows, while the controller already
processes the frames.
Assumption: no physical time passes between SYNCs. If drives must stop and no SYNC arrives any more, their stopping
ramps are completed at once.
Source: CiA 301 (predefined connection set, SYNC, NMT).
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Sequence

import numpy as np

from hexdbb.errors import InputError, RunError
from hexdbb.machine import MachineFile
from hexdbb.rig.drive import DriveNode, DriveSetup
from hexdbb.rig.faults import Injection
from hexdbb.rig.frame import HEARTBEAT_BASE, NMT, SDO_REQUEST_BASE, SYNC, Frame
from hexdbb.rig.gauge import GaugeNode, GaugeSetup
from hexdbb.rig.geometry import Array, rotation_rpy, true_geometry
from hexdbb.rig.node import Node
from hexdbb.rig.plant import Plant
from hexdbb.rig.truth import TruthFile

log = logging.getLogger(__name__)

COAST_AFTER_S = 0.1
"""Wall-clock time without a SYNC after which the ramps of stopping drives are completed, s: the RPDO timeout of the
shipped machine file, long after the last SYNC of a controller that still runs."""
COAST_LIMIT_S = 10.0
"""Longest simulated time of these ramps, s. It only bounds the loop: the shipped quick stop ramp needs 0.1 s."""


class Rig:
    """Seven nodes and a machine.

    Parameters
    ----------
    machine : MachineFile
        Nominal machine and bus set-up.
    truth : TruthFile
        Errors of the true machine.
    injections : list of Injection
        Faults to be injected.
    stall_tolerance_s : float
        Added to wall-clock timeouts, s; see `Node`.

    Attributes
    ----------
    transmit : callable
        Called with a list of frames that are to be sent together; set by the server of the bus.
    on_bus_lost : callable
        Breaks the connection to the bus; set by the server of the bus.

    Raises
    ------
    InputError
        An EDS does not exist, the start pose is out of reach, or a fault names an unknown node.
    """

    def __init__(
        self,
        machine: MachineFile,
        truth: TruthFile,
        injections: list[Injection] | None = None,
        stall_tolerance_s: float = 0.0,
    ) -> None:
        self.transmit: Callable[[list[Frame]], None] = lambda frames: None
        self.on_bus_lost: Callable[[], None] = lambda: None
        self._outbox: list[Frame] = []
        self._injections = list(injections or [])
        position, rotation = np.array(truth.start.position_mm), rotation_rpy(*np.radians(truth.start.rpy_deg))
        self.plant = Plant(truth.true_machine(machine), position, rotation)
        start_mm = start_sliders_mm(machine, position, rotation)
        self.drives = self._make_drives(machine, truth, start_mm, stall_tolerance_s)
        self.gauge = self._make_gauge(machine, truth, stall_tolerance_s)
        self.nodes: dict[int, Node] = {node.node_id: node for node in (*self.drives, self.gauge)}
        for injection in self._injections:
            injection.check(self)
        for node in self.nodes.values():
            node.on_routes_changed = self._route
        self.dt_s = machine.can_setup.cycle_s
        self.enabled_s: float | None = None
        self._broken = False
        self._last_sync_s = 0.0
        self._route()
        self._step_plant(0.0)
        self._inject()

    def _make_drives(
        self, machine: MachineFile, truth: TruthFile, start_mm: Array, stall_tolerance_s: float
    ) -> list[DriveNode]:
        can, drives = machine.can_setup, []
        travels_mm = machine.sliders.travels_mm
        for node_id, name, slider_mm, travel_mm in zip(
            can.drive_nodes, can.drive_eds, start_mm, travels_mm, strict=True
        ):
            setup = DriveSetup(
                can.counts_per_mm,
                travel_mm,
                machine.sliders.screw_lead_mm,
                float(slider_mm),
                truth.drive.lag_s,
                truth.drive.velocity_feedforward,
            )
            drives.append(DriveNode(node_id, machine.eds_path(name), self._send, setup, stall_tolerance_s))
        return drives

    def _make_gauge(self, machine: MachineFile, truth: TruthFile, stall_tolerance_s: float) -> GaugeNode:
        can, gauge = machine.can_setup, truth.gauge
        setup = GaugeSetup(gauge.noise_um, gauge.resolution_um, gauge.range_um, truth.seed)
        return GaugeNode(can.gauge_node, machine.eds_path(can.gauge_eds), self._send, setup, stall_tolerance_s)

    def receive_all(self, frames: Sequence[Frame]) -> None:
        """Process frames from the bus that were read together, in order."""
        now_s = time.monotonic()
        for cob_id, data in frames:
            if (handle := self._rpdo_handlers.get(cob_id)) is not None:
                handle(data, now_s)
            elif cob_id == SYNC:
                self._on_sync(data)
            else:
                self._receive_other(cob_id, data)
            if self._outbox:
                self.flush()

    def receive(self, cob_id: int, data: bytes) -> None:
        """Process one frame from the bus."""
        self.receive_all([(cob_id, data)])

    def _receive_other(self, cob_id: int, data: bytes) -> None:
        if cob_id == NMT:
            self._on_nmt(data)
        elif HEARTBEAT_BASE < cob_id <= HEARTBEAT_BASE + 127:
            for listener in self.nodes.values():
                listener.handle_heartbeat(cob_id - HEARTBEAT_BASE, time.monotonic())
        elif (node := self.nodes.get(cob_id - SDO_REQUEST_BASE)) is not None:
            node.handle_sdo(data)

    def flush(self) -> None:
        """Transmit the frames that the nodes have sent."""
        if self._outbox:
            frames, self._outbox = self._outbox, []
            self.transmit(frames)

    def _send(self, cob_id: int, data: bytes) -> None:
        self._outbox.append((cob_id, data))

    def _route(self) -> None:
        pairs = [(node.rpdo, node.handle_rpdo) for node in self.nodes.values()]
        self._rpdo_handlers = {rpdo.cob_id: handle for rpdo, handle in pairs if rpdo is not None and rpdo.valid}

    def _on_nmt(self, data: bytes) -> None:
        if len(data) < 2:
            return
        command, addressed = data[0], data[1]
        for node in self.nodes.values():
            if addressed in (0, node.node_id):
                node.handle_nmt(command)

    def _on_sync(self, data: bytes) -> None:
        accepting = [node for node in self.nodes.values() if node.accepts_sync(data)]
        if not accepting:  # a repeated SYNC, or one of the wrong length: no time passes
            self.flush()
            return
        self._last_sync_s = time.monotonic()
        self._read_gauge()
        for node in accepting:
            node.sample()
        self.flush()
        self._advance(accepting)

    @property
    def running_s(self) -> float | None:
        """SYNC time since all six drives were first enabled, s; None before."""
        return None if self.enabled_s is None else self.plant.time_s - self.enabled_s

    def _advance(self, accepting: Sequence[Node]) -> None:
        self.dt_s = self._period_s()
        for node in accepting:
            node.apply(self.dt_s)
        self._step_plant(self.dt_s)
        if self.enabled_s is None and all(drive.enabled for drive in self.drives):
            self.enabled_s = self.plant.time_s
        if self._injections:
            self._inject()

    def _period_s(self) -> float:
        """Return the time that one SYNC stands for, s: its period, or the interpolation period where it has none."""
        dictionary = self.drives[0].dictionary
        if period_us := dictionary.number(0x1006):
            return period_us * 1e-6
        if (0x60C2, 1) in dictionary and (0x60C2, 2) in dictionary:
            return dictionary.number(0x60C2, 1) * 10.0 ** dictionary.number(0x60C2, 2) or self.dt_s
        return self.dt_s

    def _step_plant(self, dt_s: float) -> None:
        try:
            self.plant.step([drive.axis.position_mm for drive in self.drives], dt_s, self.gauge.mounted)
        except RunError as error:
            if not self._broken:
                log.error("%s", error)
            self._broken = True
        self.gauge.moving = any(drive.axis.demand_velocity_mm_s != 0.0 for drive in self.drives)

    def _read_gauge(self) -> None:
        mounted = self.gauge.mounted
        self.gauge.true_reading_um = None if mounted is None or self._broken else self.plant.reading_mm(mounted) * 1e3

    def _inject(self) -> None:
        running_s = self.running_s
        for injection in [each for each in self._injections if each.due(running_s)]:
            self._injections.remove(injection)
            log.warning("fault injected: %s", injection)
            injection.apply(self)

    def poll(self, now_s: float) -> None:
        """Run everything that depends on wall-clock time (`now_s`, monotonic); call every few milliseconds."""
        for node in self.nodes.values():
            node.poll(now_s)
        if now_s - self._last_sync_s > COAST_AFTER_S and any(drive.stopping for drive in self.drives):
            self.coast()
        self.flush()

    def controller_gone(self) -> None:
        """React to the disconnection of the last client: enabled drives stop on their own."""
        for drive in self.drives:
            drive.on_connection_lost("no client on the bus")
        self.coast()
        self._outbox.clear()

    def coast(self) -> None:
        """Complete the stops without SYNC, and log the positions of the drives."""
        moving = [drive for drive in self.drives if drive.stopping]
        begun_s = self.plant.time_s
        while any(drive.stopping for drive in self.drives) and self.plant.time_s - begun_s < COAST_LIMIT_S:
            for drive in self.drives:
                if not drive.enabled:
                    drive.on_cycle(self.dt_s)
            self._step_plant(self.dt_s)
        for drive in moving:
            log.warning("node %d: stopped at %.4f mm, %s", drive.node_id, drive.axis.position_mm, drive.state.name)


def start_sliders_mm(machine: MachineFile, position_mm: Array, rotation: Array) -> Array:
    """Return the nominal slider coordinates of a start pose.

    Parameters
    ----------
    machine : MachineFile
        Nominal machine.
    position_mm : numpy.ndarray
        Platform position in the base frame, mm, shape (3,).
    rotation : numpy.ndarray
        Platform rotation, shape (3, 3).

    Returns
    -------
    numpy.ndarray
        Slider coordinates, mm, shape (6,).

    Raises
    ------
    InputError
        The pose is out of reach or out of travel.
    """
    try:
        sliders = true_geometry(machine).sliders_for(position_mm, rotation)
    except InputError as error:
        raise InputError(f"start {error}") from None
    for slider, (at_mm, (low, high)) in enumerate(zip(sliders, machine.sliders.travels_mm, strict=True), start=1):
        if not low <= at_mm <= high:
            raise InputError(f"start pose: slider {slider} at {at_mm:.3f} mm (expected within {low:g} to {high:g})")
    return sliders
