"""Components of a kind, of a generated module."""

from typing import assert_type

from motors_scl import Controller, Motor, MotorInstance, MotorPeer

motor = Motor()
assert_type(motor.instance, MotorInstance)
Motor(MotorInstance.LEFT_MOTOR, transport="tcp")
Motor("left_motor")  # error: MotorInstance
Motor(MotorInstance.MIDDLE_MOTOR)  # error: MIDDLE_MOTOR
Controller(MotorInstance.LEFT_MOTOR)  # error: positional
assert_type(Motor.test(), tuple[Motor, MotorPeer])
motor.instance = MotorInstance.RIGHT_MOTOR  # error: instance
