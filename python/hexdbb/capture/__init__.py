"""`hexdbb-run`: the CANopen controller that drives a plan's circles and records them.

From the bus up: `transport` opens it, `link` shares it, `sdo`, `settings` and `boot` make the nodes ready, `exchange`
and `loop` run cycles, `motion` moves axes with them under the eyes of `checks`, `samples` keeps what was captured, and
`session` is one measurement.
"""

from hexdbb.capture.clock import Clock, Deadlines, Lockstep
from hexdbb.capture.request import Progress, Request, prepare
from hexdbb.capture.session import measure
from hexdbb.capture.simulated import simulated_rig
from hexdbb.capture.transport import open_bus

__all__ = [
    "Clock",
    "Deadlines",
    "Lockstep",
    "Progress",
    "Request",
    "measure",
    "open_bus",
    "prepare",
    "simulated_rig",
]
