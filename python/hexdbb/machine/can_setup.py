"""The `[can]` section of a machine file: node ids, encoder scale, supervision times and motion limits.

Assumption: six CiA 402 drives, one per slider in slider order, and one CiA 404 gauge on one classical CAN bus.
Source: CiA 301 (bit rates, node ids 1 to 127), CiA 402, CiA 404. Defaults are the shipped machine's values.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, field_validator, model_validator

from hexdbb.files.validation import BadValueError, Number, Positive, StrictModel
from hexdbb.machine.shipped import shipped_can

NodeId = Annotated[int, Field(ge=1, le=127)]
Milliseconds = Annotated[int, Field(gt=0, le=65535)]
"""A time as CANopen objects 1016h, 1017h and 1400h:05 hold it: 16 bits."""
Six = Annotated[tuple[NodeId, NodeId, NodeId, NodeId, NodeId, NodeId], Field(strict=False)]
SixNames = Annotated[tuple[str, str, str, str, str, str], Field(strict=False)]
Bitrate = Literal[10_000, 20_000, 50_000, 125_000, 250_000, 500_000, 800_000, 1_000_000]

DEFAULTS = shipped_can()
CYCLE_RATE_MAX_HZ = 1000.0
"""Limits the SYNC rate: the frames of seven nodes fill 1 Mbit/s below this rate (bus load is checked on its own), so a
larger value is a mistake, such as a rate in another unit."""


class Limits(StrictModel):
    """Limits of every command and of every reading, for each slider alone."""

    velocity_mm_s: Positive = DEFAULTS["limits"]["velocity_mm_s"]
    """Largest velocity of a slider."""
    acceleration_mm_s2: Positive = DEFAULTS["limits"]["acceleration_mm_s2"]
    """Largest acceleration of a slider."""
    jerk_mm_s3: Positive = DEFAULTS["limits"]["jerk_mm_s3"]
    """Largest jerk of a slider."""
    following_error_mm: Positive = DEFAULTS["limits"]["following_error_mm"]
    """Largest distance between commanded and actual slider coordinate; beyond it all axes stop."""
    gauge_range_um: Positive = DEFAULTS["limits"]["gauge_range_um"]
    """Largest reading, to either side; beyond it, or beyond the plan's `gauge.range_um`, all axes stop."""
    gauge_step_um: Positive = DEFAULTS["limits"]["gauge_step_um"]
    """Largest step of the reading from one sample to the next that is no smooth motion's; beyond it, where no slider
    reverses, all axes stop."""


class CanSetup(StrictModel):
    """Drives and gauge on the bus."""

    bitrate_bit_s: Bitrate = DEFAULTS["bitrate_bit_s"]
    """Bit rate of the bus."""
    cycle_rate_hz: Annotated[Positive, Field(le=CYCLE_RATE_MAX_HZ)] = DEFAULTS["cycle_rate_hz"]
    """SYNC frames, and so samples, per second."""
    counts_per_mm: Number = DEFAULTS["counts_per_mm"]
    """Encoder increments per mm of slider travel, not 0; negative where a drive counts the other way."""
    drive_nodes: Six = tuple(DEFAULTS["drive_nodes"])
    """Node ids of the drives of sliders 1 to 6, all different."""
    gauge_node: NodeId = DEFAULTS["gauge_node"]
    """Node id of the gauge, different from those of the drives."""
    drive_eds: SixNames = (DEFAULTS["drive_eds"],) * 6
    """EDS file of each drive, relative to the machine file, or the name of a shipped one; one text for all six."""
    gauge_eds: str = DEFAULTS["gauge_eds"]
    """EDS file of the gauge, relative to the machine file, or the name of a shipped one."""
    heartbeat_producer_ms: Milliseconds = DEFAULTS["heartbeat_producer_ms"]
    """Heartbeat period of every node and of the controller (1017h)."""
    heartbeat_consumer_ms: Milliseconds = DEFAULTS["heartbeat_consumer_ms"]
    """Age beyond which a heartbeat counts as lost (1016h); more than `heartbeat_producer_ms`."""
    rpdo_timeout_ms: Milliseconds = DEFAULTS["rpdo_timeout_ms"]
    """Time without a target after which a drive stops on its own (1400h:05)."""
    limits: Limits = Field(default_factory=Limits)  # an instance here would have all compiled on import
    """Limits of motion and readings."""

    @field_validator("drive_eds", mode="before")
    @classmethod
    def _one_name_for_all(cls, value: object) -> object:
        return (value,) * 6 if isinstance(value, str) else value

    @model_validator(mode="after")
    def _consistent(self) -> CanSetup:
        if self.counts_per_mm == 0.0:
            raise BadValueError(("counts_per_mm",), self.counts_per_mm, "a number other than 0")
        for index, node in enumerate(self.drive_nodes):
            if node in self.drive_nodes[:index]:
                raise BadValueError(("drive_nodes", index), node, "a node id not used by another drive")
        if self.gauge_node in self.drive_nodes:
            raise BadValueError(("gauge_node",), self.gauge_node, "a node id not used by a drive")
        if self.heartbeat_consumer_ms <= self.heartbeat_producer_ms:
            expected = f"more than heartbeat_producer_ms, {self.heartbeat_producer_ms}"
            raise BadValueError(("heartbeat_consumer_ms",), self.heartbeat_consumer_ms, expected)
        return self

    @property
    def cycle_s(self) -> float:
        """Time between two SYNC frames, s."""
        return 1.0 / self.cycle_rate_hz
