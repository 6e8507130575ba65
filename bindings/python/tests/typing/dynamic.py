"""Components that are opened without generated code."""

from typing import Any, assert_type

import scl

controller = scl.open("topology.yaml", "controller")
controller.actuator.send(controller.actuator.type(throttle=0.5))
assert_type(controller.actuator, Any)
controller.ready(timeout="1s")  # error: timeout float
scl.opn("topology.yaml", "controller")  # error: opn
