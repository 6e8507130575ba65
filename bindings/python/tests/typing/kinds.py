"""Components of a kind, of a generated module."""

from typing import Any, assert_type

from motors_scl import Controller, Display, DisplayNumbersSender, Motor, MotorInstance, MotorPeer

motor = Motor()
assert_type(motor.instance, MotorInstance)
Motor(MotorInstance.LEFT_MOTOR, transport="tcp")
Motor("left_motor")  # error: MotorInstance
Motor(MotorInstance.MIDDLE_MOTOR)  # error: MIDDLE_MOTOR
Controller(MotorInstance.LEFT_MOTOR)  # error: positional
assert_type(Motor.test(), tuple[Motor, MotorPeer])
motor.instance = MotorInstance.RIGHT_MOTOR  # error: instance

controller, display = Controller(), Display()
assert_type(controller.states.recv_from(timeout=1), tuple[MotorInstance, Any])
assert_type(controller.states.sender, MotorInstance | None)
assert_type(display.numbers.recv_from()[0], DisplayNumbersSender)
assert_type(display.numbers.sender, DisplayNumbersSender | None)
motor.setpoint.recv_from()  # error: recv_from
assert_type(motor.setpoint.sender, str | None)
display.numbers.sender = DisplayNumbersSender.LEFT_MOTOR  # error: sender
