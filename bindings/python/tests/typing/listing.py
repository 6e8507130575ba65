"""The shortest program, and what editors know in it."""

from typing import assert_type

from rover_scl import Actuator, Setpoint


def update_setpoint(throttle: float) -> None:
    print(throttle)


with Actuator() as a:
    for setpoint in a.setpoint:
        update_setpoint(setpoint.throttle)

        assert_type(setpoint, Setpoint)
        assert_type(setpoint.throttle, float)
        update_setpoint(setpoint.throtle)  # error: throtle
