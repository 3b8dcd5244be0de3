#!/usr/bin/python3
"""Replace LinuxCNC's user interface: switch on, home, run a program, read the pose of the platform, end.

LinuxCNC starts it as [DISPLAY]DISPLAY with `-ini FILE`; the program is [DISPLAY]OPEN_FILE. It writes `operator.json`.
Runs under the distribution's Python, which has the module `linuxcnc`.
"""

import json
import sys
import time
from pathlib import Path

import linuxcnc

PATIENCE_S = 300.0


def reported(errors):
    """Return the errors that LinuxCNC has reported; several often follow each other."""
    found = []
    report = errors.poll()
    while report is not None:
        if report[0] in (linuxcnc.NML_ERROR, linuxcnc.OPERATOR_ERROR):
            found.append(f"error: LinuxCNC: {report[1].strip()}")
        time.sleep(0.2)
        report = errors.poll()
    return found


def wait_until(is_so, status, errors, what):
    """Poll LinuxCNC until a condition holds; an error it reports ends the run."""
    deadline = time.monotonic() + PATIENCE_S
    while True:
        status.poll()
        found = reported(errors)
        if found:
            sys.exit("\n".join(found))
        if is_so():
            return
        if time.monotonic() > deadline:
            sys.exit(f"error: {what}: not within {PATIENCE_S:g} s")
        time.sleep(0.02)


def main():
    ini = linuxcnc.ini(sys.argv[sys.argv.index("-ini") + 1])
    command, status, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()

    def wait(is_so, what):
        wait_until(is_so, status, errors, what)

    command.state(linuxcnc.STATE_ESTOP_RESET)
    wait(lambda: status.task_state != linuxcnc.STATE_ESTOP, "emergency stop reset")
    command.state(linuxcnc.STATE_ON)
    wait(lambda: status.task_state == linuxcnc.STATE_ON, "machine on")
    command.home(-1)
    wait(lambda: all(status.homed[: status.joints]), "homing")
    command.mode(linuxcnc.MODE_AUTO)
    wait(lambda: status.task_mode == linuxcnc.MODE_AUTO, "automatic mode")
    command.program_open(ini.find("DISPLAY", "OPEN_FILE"))
    command.auto(linuxcnc.AUTO_RUN, 1)
    wait(lambda: status.interp_state != linuxcnc.INTERP_IDLE, "begin of the program")
    wait(lambda: status.interp_state == linuxcnc.INTERP_IDLE and status.inpos, "end of the program")
    poses = {"commanded": status.position[:6], "actual": status.actual_position[:6]}
    Path("operator.json").write_text(json.dumps(poses), encoding="utf-8")


main()
