"""`hexdbb-run`: the CANopen controller that drives the circles of a plan and records them.

Modules from the bus upwards: `transport` opens the bus, `frames` examines what comes from it and `link` shares it
between threads; `eds` reads what devices are, `fitness` decides whether they can run the test; `sdo`, `settings`,
`configuration` and `boot` configure the nodes; `exchange` and `loop` run the communication cycles; `motion` moves the
axes while `checks` examines every answer; `sample_buffer` turns answers into rows of the record; `session` is one
measurement.

Source: CiA 301 (application layer), CiA 402-2 (drives), CiA 404 (measuring devices).
"""

from hexdbb.capture.buses import SimulatedRig, opened_bus, running_clock
from hexdbb.capture.clock import Clock, Deadlines, Lockstep
from hexdbb.capture.interrupts import Interrupts
from hexdbb.capture.request import Request, RunProgress, prepare
from hexdbb.capture.session import measure
from hexdbb.capture.simulated import simulated_rig
from hexdbb.capture.transport import open_bus

__all__ = [
    "Clock",
    "Deadlines",
    "Interrupts",
    "Lockstep",
    "Request",
    "RunProgress",
    "SimulatedRig",
    "measure",
    "open_bus",
    "opened_bus",
    "prepare",
    "running_clock",
    "simulated_rig",
]
