"""A CiA 402 drive of one slider: state machine, cyclic synchronous position mode, limits, following error, stops.

Model: in every cycle the drive obeys the controlword, supervises its limits and moves its servo axis for one
communication cycle. Enabled in mode 8 it follows the target; in every other state it brakes to a standstill and holds.
Assumption: the encoder is absolute, so the drive is homed at power-on; mode 8 is the only mode offered.
Source: CiA 402-2: reactions by 6007h, 605Ah and 605Eh, EMCY codes of the error code table.
"""

from __future__ import annotations

import logging
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from canopen.sdo import SdoAbortedError

from hexdbb.rig import cia402
from hexdbb.rig.cia402 import DriveState
from hexdbb.rig.dictionary import ABORT_VALUE_RANGE, Key, Value
from hexdbb.rig.node import CURRENT, GENERIC, PROFILE, Node, Send
from hexdbb.rig.servo import ServoAxis

log = logging.getLogger(__name__)

CYCLIC_SYNCHRONOUS_POSITION = 8
"""Mode of operation, objects 6060h and 6061h."""
ERROR_OVERCURRENT, ERROR_FOLLOWING, ERROR_LIMIT_SWITCH = 0x2310, 0x8611, 0x8612
"""EMCY error codes of CiA 402."""
NEGATIVE_LIMIT, POSITIVE_LIMIT = 1, 2
"""Bits of the digital inputs 60FDh."""
STAY_IN_QUICK_STOP = (5, 6)
"""Quick stop option codes 605Ah that end in quick stop active; the others end in switch on disabled."""
ABORT_FAULT, ABORT_DISABLE, ABORT_QUICK_STOP = 1, 2, 3
"""Abort connection option codes 6007h."""
_ALWAYS = cia402.VOLTAGE_ENABLED | cia402.REMOTE
_ENABLED, _QUICK_STOP = DriveState.OPERATION_ENABLED, DriveState.QUICK_STOP_ACTIVE
"""Looked up in every cycle: a member of an enumeration costs much more than a name of the module."""
_POWERED = (DriveState.OPERATION_ENABLED, DriveState.QUICK_STOP_ACTIVE, DriveState.FAULT_REACTION_ACTIVE)


@dataclass(frozen=True)
class DriveSetup:
    """Properties of a drive that are not in its EDS.

    Attributes
    ----------
    counts_per_mm : float
        Encoder scale; negative if the encoder counts the other way.
    travel_mm : tuple of float
        Ends of travel, mm; become the software position limit 607Dh.
    screw_lead_mm : float
        Travel per turn of the screw, mm.
    start_mm : float
        Position at power-on, mm.
    lag_s : float
        Time constant of the position loop, s.
    feedforward : float
        Velocity feed-forward, 0 to 1.
    """

    counts_per_mm: float
    travel_mm: tuple[float, float]
    screw_lead_mm: float
    start_mm: float
    lag_s: float
    feedforward: float


class DriveNode(Node):
    """One drive on the bus; the parameters not named here are those of `Node`.

    Parameters
    ----------
    setup : DriveSetup
        Scale, travel, dynamics.
    """

    device_name = b"simulated CiA 402 drive"
    required: ClassVar[dict[Key, str]] = {
        **Node.required,
        (0x1400, 1): "I",
        (0x1600, 0): "B",
        (0x6040, 0): "Hh",
        (0x6041, 0): "Hh",
        (0x6060, 0): "bB",
        (0x6061, 0): "bB",
        (0x6064, 0): "iI",
        (0x607A, 0): "iI",
    }
    assumed: ClassVar[dict[Key, int]] = {
        **Node.assumed,
        (0x6007, 0): ABORT_QUICK_STOP,
        (0x605A, 0): 2,
        (0x603F, 0): 0,
        (0x606C, 0): 0,
        (0x60F4, 0): 0,
        (0x60FD, 0): 0,
        (0x6065, 0): 10_000,
        (0x6066, 0): 20,
        (0x607F, 0): 5_000_000,
        (0x6085, 0): 20_000_000,
        (0x607D, 1): 0,
        (0x607D, 2): 0,
        (0x608F, 1): 1,
        (0x6092, 1): 1,
        (0x60C2, 1): 4,
        (0x60C2, 2): -3,
    }

    def __init__(self, node_id: int, eds: Path, send: Send, setup: DriveSetup, stall_tolerance_s: float = 0.0) -> None:
        self.setup = setup
        self.axis = ServoAxis(setup.start_mm, setup.lag_s, setup.feedforward)
        self.homed = True
        super().__init__(node_id, eds, send, stall_tolerance_s)

    def on_power_up(self) -> None:
        """Set scale, limits and target for the present position of the axis."""
        entry = self.dictionary.entry
        self.state = DriveState.SWITCH_ON_DISABLED
        self.limit_inputs = 0
        self._limited = False
        self._previous_controlword = 0
        self._obeyed_in: DriveState | None = None
        self._late_s = 0.0
        self.dictionary.hooks[0x6060, 0] = self._check_mode
        self._controlword, self._statusword = entry(0x6040), entry(0x6041)
        self._target, self._position = entry(0x607A), entry(0x6064)
        self._velocity, self._error = entry(0x606C), entry(0x60F4)
        self._mode, self._mode_display = entry(0x6060), entry(0x6061)
        self._inputs, self._error_code = entry(0x60FD), entry(0x603F)
        self._window, self._window_ms, self._max_velocity = entry(0x6065), entry(0x6066), entry(0x607F)
        self._interpolation = entry(0x60C2, 1), entry(0x60C2, 2)
        self._limits = entry(0x607D, 1), entry(0x607D, 2)
        scale = self.setup.counts_per_mm
        for limit, counts in zip(self._limits, sorted(round(mm * scale) for mm in self.setup.travel_mm), strict=True):
            limit.value = counts
        for index in (0x608F, 0x6092):
            entry(index, 1).value = round(abs(scale) * self.setup.screw_lead_mm)
        self.axis.hold_here()
        self._target.value = round(self.axis.position_mm * scale)
        self.refresh()

    @property
    def enabled(self) -> bool:
        """Whether the drive follows or may follow targets."""
        return self.state is _ENABLED

    @property
    def stopping(self) -> bool:
        """Whether the drive is stopping on its own."""
        return not self.enabled and (not self.axis.at_standstill or self._after_stop() is not None)

    def on_sample(self) -> None:
        """Write the values of this SYNC, as far as the TPDO carries them."""
        if self._carries_rest:
            self.refresh()
        else:
            self._write_position_and_status()

    def on_mapping_changed(self) -> None:
        """Look whether the TPDO carries more than positions and status."""
        self._carries_rest = any(entry in self.tpdo.entries for entry in (self._velocity, self._error, self._inputs))

    def refresh(self) -> None:
        """Write the present position, velocity, following error and statusword."""
        axis, scale = self.axis, self.setup.counts_per_mm
        self._velocity.value = round(axis.velocity_mm_s * scale)
        self._error.value = round(axis.following_error_mm * scale)
        self._inputs.value = self.limit_inputs
        self._write_position_and_status()

    def _write_position_and_status(self) -> None:
        self._position.value = round(self.axis.position_mm * self.setup.counts_per_mm)
        word = self.state | _ALWAYS
        if self.homed:
            word |= cia402.HOMED
        limited = self._limited
        if limited or self.limit_inputs:
            word |= cia402.INTERNAL_LIMIT
        if self._late_s > 0.0:
            word |= cia402.FOLLOWING_ERROR
        if not limited and self._follows:
            word |= cia402.FOLLOWS_COMMAND
        self._statusword.value = word

    @property
    def _follows(self) -> bool:
        """Whether the drive is enabled in mode 8 and not halted."""
        return (
            self.state is _ENABLED
            and self._mode_display.value == CYCLIC_SYNCHRONOUS_POSITION
            and not int(self._controlword.value) & cia402.HALT_BIT
        )

    def on_cycle(self, dt_s: float) -> None:
        """Obey the controlword, move, supervise the following error."""
        if self.state is not self._obeyed_in or self._controlword.value != self._previous_controlword:
            self._obey_controlword()
        mode = self._mode.value
        if mode in (0, CYCLIC_SYNCHRONOUS_POSITION):
            self._mode_display.value = mode
        if self._follows:
            self._follow(dt_s)
        else:
            self._limited = False
            self.axis.brake(dt_s, self.dictionary.number(0x6085) / abs(self.setup.counts_per_mm))
            self._end_stop()
        self._supervise_following_error(dt_s)

    def _follow(self, dt_s: float) -> None:
        scale, target = self.setup.counts_per_mm, int(self._target.value)
        low, high = int(self._limits[0].value), int(self._limits[1].value)
        within = target if low <= target <= high else min(max(target, low), high)
        period, exponent = self._interpolation
        interpolation_s = int(period.value) * 10.0 ** int(exponent.value)
        held_back = self.axis.follow(within / scale, interpolation_s, dt_s, int(self._max_velocity.value) / abs(scale))
        self._limited = held_back or within != target

    def _obey_controlword(self) -> None:
        word = int(self._controlword.value)
        changed = word != self._previous_controlword
        rising, self._previous_controlword, self._obeyed_in = word & ~self._previous_controlword, word, None
        if self.state is DriveState.FAULT and rising & cia402.FAULT_RESET_BIT:
            self._enter(DriveState.SWITCH_ON_DISABLED)
            self._error_code.value = 0
            self.emergency(0)
        for _ in range(2):  # ready to switch on -> switched on -> operation enabled in one command
            following = cia402.next_state(self.state, word)
            if following is None:
                self._obeyed_in = self.state  # the same word asks for nothing more while this state lasts
                return
            if self.state is _QUICK_STOP and following is _ENABLED and not changed:
                return  # a stop of the drive's own is not undone by an unchanged controlword
            if following is _ENABLED and self.state is DriveState.SWITCHED_ON and not self._bumpless():
                self.trip(ERROR_FOLLOWING, PROFILE)
                return
            self._enter(following)

    def _bumpless(self) -> bool:
        """Whether the target is within the following error window, so that enabling moves nothing."""
        if self._mode.value != CYCLIC_SYNCHRONOUS_POSITION:
            return True
        position = round(self.axis.position_mm * self.setup.counts_per_mm)
        return abs(int(self._target.value) - position) <= int(self._window.value)

    def _enter(self, state: DriveState) -> None:
        if state is _ENABLED:
            self.axis.hold_here()
        if state is not self.state:
            log.debug("node %d: %s -> %s", self.node_id, self.state.name, state.name)
        self.state = state

    def _end_stop(self) -> None:
        following = self._after_stop()
        if following is not None and self.axis.at_standstill:
            self._enter(following)

    def _after_stop(self) -> DriveState | None:
        """Return the state that a stop leads to; None without a stop, or if it ends in the present state."""
        if self.state is DriveState.FAULT_REACTION_ACTIVE:
            return DriveState.FAULT
        if self.state is DriveState.QUICK_STOP_ACTIVE and self.dictionary.number(0x605A) not in STAY_IN_QUICK_STOP:
            return DriveState.SWITCH_ON_DISABLED
        return None

    def _supervise_following_error(self, dt_s: float) -> None:
        axis = self.axis
        error_mm = axis.demand_mm - axis.position_mm
        outside = abs(error_mm * self.setup.counts_per_mm) > int(self._window.value)
        self._late_s = self._late_s + dt_s if outside and self.state is _ENABLED else 0.0
        if self._late_s * 1000.0 > int(self._window_ms.value):
            self.trip(ERROR_FOLLOWING, PROFILE)

    def trip(self, code: int = ERROR_OVERCURRENT, register: int = CURRENT) -> None:
        """Enter the fault reaction with an EMCY of this error code and error register bit."""
        self._error_code.value = code
        self.emergency(code, register)
        self._enter(DriveState.FAULT_REACTION_ACTIVE if self.state in _POWERED else DriveState.FAULT)

    def quick_stop(self) -> None:
        """Stop on the quick stop ramp, as on the controlword command."""
        if self.enabled:
            self._enter(DriveState.QUICK_STOP_ACTIVE)

    def disable(self) -> None:
        """Remove the power: switch on disabled."""
        if self.state in (DriveState.READY_TO_SWITCH_ON, DriveState.SWITCHED_ON, *_POWERED):
            self._enter(DriveState.SWITCH_ON_DISABLED)

    def hit_limit_switch(self, inputs: int) -> None:
        """Report limit switches (bits of 60FDh) and stop."""
        self.limit_inputs |= inputs
        self.emergency(ERROR_LIMIT_SWITCH, PROFILE)
        self.quick_stop()

    def on_connection_lost(self, reason: str) -> None:
        """React according to the abort connection option code 6007h."""
        if not self.enabled:
            return
        log.warning("node %d: %s, stopping at %.4f mm", self.node_id, reason, self.axis.position_mm)
        option = self.dictionary.number(0x6007)
        reactions = {ABORT_FAULT: self._trip_generic, ABORT_DISABLE: self.disable, ABORT_QUICK_STOP: self.quick_stop}
        reaction = reactions.get(option)
        if reaction is not None:
            reaction()

    def _trip_generic(self) -> None:
        self.trip(int(self.dictionary.entry(0x1003, 1).value) & 0xFFFF or ERROR_OVERCURRENT, GENERIC)

    def _check_mode(self, value: Value) -> None:
        if int(value) not in (0, CYCLIC_SYNCHRONOUS_POSITION):
            raise SdoAbortedError(ABORT_VALUE_RANGE)
