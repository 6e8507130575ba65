"""Plays a motor of `motors.yaml` as `motors.rs` does: the one that SCL_COMPONENT names, or `motor left_motor`.

With `motor test`, it tests itself. `motor dynamic FILE` uses the topology file instead of the generated module.
"""

import sys

import scl
from motors_scl import Motor, MotorInstance


def test() -> None:
    motor, peer = Motor.test()
    assert motor.instance is MotorInstance.LEFT_MOTOR
    peer.setpoint.send(7)
    motor.state.send(10 * motor.setpoint.recv())
    print(peer.state.recv(), flush=True)


def opened(chosen: list[str]) -> Motor | scl.DynamicComponent:
    match chosen:
        case ["dynamic", topology]:
            return scl.open(topology, "motor")
        case [instance]:
            return Motor(MotorInstance(instance))
        case _:
            return Motor()


def main() -> None:
    if sys.argv[1:] == ["test"]:
        test()
        return
    with opened(sys.argv[1:]) as motor:
        motor.ready()
        assert not isinstance(motor, Motor) or motor.instance == motor.name
        print(motor.name, flush=True)
        while True:
            motor.state.send(10 * motor.setpoint.recv())


main()
