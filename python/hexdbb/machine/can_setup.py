"""The `[can]` section of a machine file: which node is which, the encoder scale, supervision times and motion limits.

Assumption: six CiA 402 drives, one per slider in slider order, and one CiA 404 gauge on one classical CAN bus.
Source: CiA 301 (bit rates, node ids 1 to 127), CiA 402, CiA 404.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, field_validator, model_validator

from hexdbb.files.validation import BadValueError, Number, Positive, StrictModel

NodeId = Annotated[int, Field(ge=1, le=127)]
Milliseconds = Annotated[int, Field(gt=0, le=65535)]
"""A time as CANopen objects 1016h, 1017h and 1400h:05 hold it: 16 bits."""
Six = Annotated[tuple[NodeId, NodeId, NodeId, NodeId, NodeId, NodeId], Field(strict=False)]
SixNames = Annotated[tuple[str, str, str, str, str, str], Field(strict=False)]
Bitrate = Literal[10_000, 20_000, 50_000, 125_000, 250_000, 500_000, 800_000, 1_000_000]


class Limits(StrictModel):
    """What no command and no reading may exceed; each slider alone."""

    velocity_mm_s: Positive = 250.0
    acceleration_mm_s2: Positive = 2500.0
    jerk_mm_s3: Positive = 50_000.0
    following_error_mm: Positive = 3.0
    """Largest distance between commanded and actual position before all axes stop."""
    gauge_range_um: Positive = 1000.0
    """Largest reading, to either side, before all axes stop."""


class CanSetup(StrictModel):
    """Drives and gauge on the bus."""

    bitrate_bit_s: Bitrate = 1_000_000
    cycle_rate_hz: Annotated[Positive, Field(le=1000.0)] = 250.0
    """SYNC frames, and so samples, per second."""
    counts_per_mm: Number = 10_000.0
    """Encoder increments per mm of slider travel; negative where a drive counts the other way."""
    drive_nodes: Six = (1, 2, 3, 4, 5, 6)
    """Node ids of the drives of sliders 1 to 6."""
    gauge_node: NodeId = 7
    drive_eds: SixNames = ("hexglider_drive.eds",) * 6
    """EDS file of each drive, relative to the machine file, or the name of a shipped one; one text stands for all."""
    gauge_eds: str = "ballbar_gauge.eds"
    heartbeat_producer_ms: Milliseconds = 100
    """Heartbeat period of every node and of the controller."""
    heartbeat_consumer_ms: Milliseconds = 300
    """A heartbeat older than this is lost."""
    rpdo_timeout_ms: Milliseconds = 100
    """A drive stops by itself after this time without a target (1400h:05)."""
    limits: Limits = Limits()

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
        """Time between two SYNC frames."""
        return 1.0 / self.cycle_rate_hz
