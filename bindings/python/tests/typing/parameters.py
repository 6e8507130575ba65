"""Parameters of components, of a generated module."""

import datetime
from typing import assert_type

import scl
from controls_scl import Controller, ControllerMode, ControllerParameters, Motor, MotorParameters, Plain

controller = Controller(set={"controller.gain": "2"})
assert_type(controller.parameters, ControllerParameters)
assert_type(controller.parameters.gain, float)
assert_type(controller.parameters.period, datetime.timedelta)
assert_type(controller.parameters.mode, ControllerMode)
assert_type(controller.parameters.names, list[str])
assert_type(controller.parameters.list, list[int])
assert_type(controller.parameters.class_, bool)
assert_type(Motor().parameters, MotorParameters)
assert_type(Motor.test(set={"left_motor.pin": "1"})[0].parameters.pin, int)
scl.open("topology.yaml", "controller", set={"controller.gain": "2"})

assert_type(controller.update_parameters(), bool)
assert_type(controller.update_parameters(timeout=None), bool)
controller.set_parameter("gain", "2")

controller.set_parameter("gain", 2)  # error: str
controller.parameters.gian  # error: gian
controller.parameters.gain = 1.0  # error: gain
controller.parameters = controller.parameters  # error: parameters
Plain().parameters  # error: parameters
Controller(set={"controller.gain": 2})  # error: str
ControllerParameters(gain=1.0)  # error: ratio
MotorParameters(pin="1", direction="auto")  # error: pin direction


def name(mode: ControllerMode) -> str:
    match mode:
        case ControllerMode.MANUAL:
            return "by hand"
        case ControllerMode.AUTO:
            return "by itself"
