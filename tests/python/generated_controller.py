"""Sends the numbers of its input as set-points."""

import sys

from rover_scl import Controller, Setpoint

with Controller() as controller:
    for line in sys.stdin:
        controller.actuator.send(Setpoint(throttle=float(line)))
        print("sent", flush=True)
