"""Plays a motor of `motors.yaml` as `motors.rs` does: the one that SCL_COMPONENT names, or `motor left_motor`.

`motor controller` and `motor display` play these, and `motor test` tests itself. `motor dynamic FILE` uses the topology file instead of the generated module.
"""

import sys

import scl
from motors_scl import Controller, Display, DisplayNumbersSender, Motor, MotorInstance


def test() -> None:
    motor, peer = Motor.test()
    assert motor.instance is MotorInstance.LEFT_MOTOR
    peer.setpoint.send(7)
    motor.state.send(10 * motor.setpoint.recv())
    print(peer.state.recv(), flush=True)


def control() -> None:
    """Follows commands such as `left 1`, and says which motor has answered."""
    with Controller() as controller:
        assert controller.states.sender is None
        print("open", flush=True)
        for line in sys.stdin:
            side, value = line.split()
            controller.ready()
            (controller.left if side == "left" else controller.right).send(int(value))
            motor, state = controller.states.recv_from()
            assert isinstance(motor, MotorInstance)
            print(motor, state, flush=True)


NAMES = {
    DisplayNumbersSender.LEFT_MOTOR: "LeftMotor",
    DisplayNumbersSender.RIGHT_MOTOR: "RightMotor",
    DisplayNumbersSender.CONTROLLER_LEFT: "ControllerLeft",
    DisplayNumbersSender.CONTROLLER_RIGHT: "ControllerRight",
}


def display() -> None:
    """Says every number and where it comes from."""
    with Display() as display:
        print("open", flush=True)
        for number in display.numbers:
            sender = display.numbers.sender
            assert isinstance(sender, DisplayNumbersSender)
            print(NAMES[sender], number, flush=True)


def opened(chosen: list[str]) -> Motor | scl.DynamicComponent:
    match chosen:
        case ["dynamic", topology]:
            return scl.open(topology, "motor")
        case [instance]:
            return Motor(MotorInstance(instance))
        case _:
            return Motor()


def main() -> None:
    match sys.argv[1:]:
        case ["test"]:
            return test()
        case ["controller"]:
            return control()
        case ["display"]:
            return display()
    with opened(sys.argv[1:]) as motor:
        motor.ready()
        assert not isinstance(motor, Motor) or motor.instance == motor.name
        print(motor.name, flush=True)
        while True:
            motor.state.send(10 * motor.setpoint.recv())


main()
