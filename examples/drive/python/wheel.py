"""A wheel: it follows the set-point, and stops when none comes."""

from time import sleep

from drive_scl import Record, Wheel, WheelState

with Wheel() as wheel:
    wheel.log.send(Record(component=wheel.name, text="runs in Python"))
    target = speed = 0.0
    while True:
        sleep(0.05)
        if wheel.setpoint.take_missed():
            target = 0.0
        if (setpoint := wheel.setpoint.latest()) is not None:
            target = setpoint.speed
        speed += (target - speed) * wheel.parameters.response
        wheel.state.send(WheelState(speed=speed, language="Python"))
