"""The simulated rig: six CiA 402 drives and a CiA 404 gauge on a CAN bus, around a hidden true machine.

Model: a process of its own whose physics advances by SYNC alone, one communication cycle period (object 1006h) per
SYNC, so that a run gives the same samples at any speed. Drives (`drive`), gauge (`gauge`) and their CANopen stack
(`node`, `pdo`, `dictionary`) know nothing of the machine; the machine (`plant`, `geometry`, `pose_solver`,
`mechanisms`) knows nothing of the bus. The truth shares no code with the engine that diagnoses it: this package
imports `hexdbb.machine`, `hexdbb.files.validation` and `hexdbb.errors` and nothing else of hexdbb.
"""
