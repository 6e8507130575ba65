"""Applies each set-point."""

from contextlib import suppress

from rover_scl import Actuator

with suppress(KeyboardInterrupt), Actuator() as actuator:
    for setpoint in actuator.setpoint:
        print(f"throttle {setpoint.throttle:+.2f}")
