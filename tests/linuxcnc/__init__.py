"""LinuxCNC with the kinematics module of `firmware_interfaces/linuxcnc`, run headless, and what a ball bar says.

LinuxCNC itself runs, as a user's would: its own interpreter, trajectory planner and servo thread. Only the drives are
simulated, and the machine behind them is that of `tests.truth`, which shares no code with the engine.
"""
