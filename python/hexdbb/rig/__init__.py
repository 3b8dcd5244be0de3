"""The simulated rig: six CiA 402 drives and a CiA 404 gauge on a CAN bus, around a hidden true machine.

Model: a separate process whose physics advances by SYNC alone, one cycle per SYNC (object 1006h, or 60C2h where that
is 0), so that a run gives the same samples at any speed. Drives (`drive`), gauge (`gauge`) and their CANopen stack
(`node`, `pdo`, `dictionary`) do not depend on the machine; the machine (`plant`, `geometry`, `pose_solver`,
`mechanisms`) does not depend on the bus.
Assumption: independence. The truth shares no code with the engine that diagnoses it and none with the controller that
drives it: this package imports `hexdbb.machine`, `hexdbb.files.validation` and `hexdbb.errors` and nothing else of
hexdbb. Names that occur in both (`DriveState`, PDO constants) are written twice on purpose.
"""
