"""Components and gates, wired by one checked YAML file, over ZeroMQ.

```python
import scl

controller = scl.open("topology.yaml", "controller")
controller.actuator.send(controller.actuator.type(throttle=0.5))
```
"""

from scl import _errors, codec
from scl._buffer import Buffer
from scl._component import Component, DynamicComponent, Transport, open, open_plan
from scl._errors import *
from scl._gates import Gate, Pub, Pull, Push, Rep, Req, Request
from scl._generated import GeneratedComponent
from scl._kinds import ComponentOfKind
from scl._native import __version__
from scl._parameters import Choice, ComponentWithParameters, Parameters
from scl._signals import stop_requested
from scl._sub import Instance, Sender, Sub, SubFrom
from scl._tasks import until_stopped
from scl._testing import Counterpart, DynamicCounterpart, TestableComponent, test

__all__ = [
    "Buffer",
    "Choice",
    "Component",
    "ComponentOfKind",
    "ComponentWithParameters",
    "Counterpart",
    "DynamicComponent",
    "DynamicCounterpart",
    "Gate",
    "GeneratedComponent",
    "Instance",
    "Parameters",
    "Pub",
    "Pull",
    "Push",
    "Rep",
    "Req",
    "Request",
    "Sender",
    "Sub",
    "SubFrom",
    "TestableComponent",
    "Transport",
    "__version__",
    "codec",
    "open",
    "open_plan",
    "stop_requested",
    "test",
    "until_stopped",
]
__all__ += _errors.__all__

# As programs name them: in tracebacks, `repr` and `help`.
for _name in __all__:
    _item = globals()[_name]
    if getattr(_item, "__module__", "").startswith("scl._"):
        _item.__module__ = "scl"
del _name, _item
