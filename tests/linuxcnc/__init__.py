"""LinuxCNC with the kinematics module of `firmware_interfaces/linuxcnc`, run headless, and the ball-bar readings.

LinuxCNC itself runs as on a user's machine: its own interpreter, trajectory planner and servo thread. Only the drives
are simulated, and the machine behind them is that of `hexdbb_truth`, which shares no code with the engine.
"""
