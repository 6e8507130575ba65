"""Unit tests of components: the other ends of gates, with the opposite directions."""

from typing import Any, assert_type

import scl
from testable_scl import Command, Controller, ControllerPeer, Empty, EmptyPeer, Reading, Setpoint, Status

pair = Controller.test()
assert_type(pair, tuple[Controller, ControllerPeer])
controller, peer = pair
assert_type(Empty.test(), tuple[Empty, EmptyPeer])

with controller, peer:
    peer.readings.send(Reading(speed=0.25))
    assert_type(controller.readings.recv(), Reading)
    assert_type(peer.setpoints.recv(), Setpoint)
    assert_type(peer.commands.call(Command()), Status)
    assert_type(peer.log.recv(), bytes)
    for request in peer.limits:
        request.reply(Status())
    peer.close()

peer.reading.send(Reading())  # error: reading
peer.readings.send(Setpoint())  # error: Setpoint Reading
peer.readings.recv()  # error: recv
peer.setpoints.send(Setpoint())  # error: send
controller.setpoints.recv()  # error: recv
peer.readings = controller.readings  # error: Reading
Controller.test("controller")  # error: argument


class Own(Controller):
    """A program's own subclass."""


assert_type(Own.test(), tuple[Own, ControllerPeer])

dynamic, other = scl.test("topology.yaml", "controller")
assert_type(dynamic, scl.DynamicComponent)
assert_type(other, scl.DynamicCounterpart)
gate: Any = other.readings
scl.test("topology.yaml")  # error: component
