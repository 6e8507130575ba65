"""Applies each set-point."""

from rover_scl import Actuator

with Actuator() as actuator:
    for setpoint in actuator.setpoint:
        print(f"throttle {setpoint.throttle:+.2f}")
