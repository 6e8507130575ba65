"""Parameters of components: their values, in which types, and what is said about wrong ones."""

from __future__ import annotations

import asyncio
import dataclasses
import datetime
import importlib.util
import pydoc
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
import scl
from conftest import System

TESTS = Path(__file__).parents[3] / "crates" / "scl-generate" / "tests"
GENERATED = TESTS / "python" / "expected" / "controls_scl.py"
TOPOLOGY = TESTS / "topologies" / "controls.yaml"
DEFAULTS: dict[str, Any] = {
    "gain": 0.8,
    "ratio": 0.5,
    "period": datetime.timedelta(milliseconds=10),
    "label": 'left "front"',
    "enabled": True,
    "mode": "manual",
    "offsets": [0.0, 0.5, -1.0],
    "names": ["a", "b, c"],
    "delays": [datetime.timedelta(milliseconds=1), datetime.timedelta(seconds=2)],
    "flags": [True, False],
    "corners": ["north", "south"],
    "limits": [],
    "i8": -8,
    "i16": -16,
    "i32": -32,
    "i64": -(2**63),
    "u8": 8,
    "u16": 16,
    "u32": 32,
    "u64": 2**64 - 1,
    "class": False,
    "list": [1, 2],
}


def _generated() -> ModuleType:
    spec = importlib.util.spec_from_file_location("controls_scl", GENERATED)
    assert spec is not None and spec.loader is not None
    module = sys.modules["controls_scl"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


generated: Any = _generated()


def _by_field(values: Any) -> dict[str, Any]:
    return {"class" if name == "class_" else name: value for name, value in dataclasses.asdict(values).items()}


def test_every_type_has_its_default() -> None:
    controller, peer = generated.Controller.test()
    with controller, peer:
        assert _by_field(controller.parameters) == DEFAULTS
        assert controller.parameters.mode is generated.ControllerMode.MANUAL
    dynamic, peer = scl.test(TOPOLOGY, "controller")
    with dynamic, peer:
        assert dict(dynamic.parameters) == DEFAULTS
        assert not hasattr(peer, "parameters")


def test_values_are_set_when_a_component_is_opened(system: System, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SCL_SET", "controller.gain=2,controller.mode=auto,left_motor.pin=3")
    where: dict[str, Any] = {"runtime_dir": system.folder, "signals": False}
    with generated.Controller(**where, set={"controller.gain": "3", "controller.names": "[x]"}) as controller:
        found = controller.parameters
        assert (found.gain, found.mode, found.names) == (3.0, generated.ControllerMode.AUTO, ["x"])
    with scl.open(TOPOLOGY, "controller", **where, set={"controller.delays": "[0.5us]"}) as dynamic:
        assert (dynamic.parameters["gain"], dynamic.parameters["mode"]) == (2.0, "auto")
        # Rounded up: a duration that is not 0 does not become 0.
        assert dynamic.parameters["delays"] == [datetime.timedelta(microseconds=1)]
    with generated.Motor(generated.MotorInstance.LEFT_MOTOR, **where) as motor:
        assert (motor.parameters.pin, motor.parameters.direction) == (3, "clock-wise")


def test_a_unit_test_sets_values_and_ignores_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SCL_SET", "left_motor.pin=1,left_motor.direction=counter_clockwise")
    motor, peer = generated.Motor.test(set={"left_motor.pin": "4"})
    with motor, peer:
        assert motor.parameters == generated.MotorParameters(pin=4, direction=generated.MotorDirection.CLOCK_WISE)
    dynamic, peer = scl.test(TOPOLOGY, "motor", set={"left_motor.pin": "5"})
    with dynamic, peer:
        assert dynamic.parameters == {"pin": 5, "direction": "clock-wise"}


@pytest.mark.parametrize(
    "values, words",
    [
        (None, "parameter `left_motor.pin` (u8) has no value"),
        ({"left_motor.pni": "1"}, "component `left_motor` has no parameter `pni`, which is set; did you mean `pin`?"),
        ({"left_motor.pin": "256"}, "cannot have the value that it is set to: expected a whole number from 0 to 255"),
        ({"pin": "1"}, "expected `component.parameter=value`, found `pin=1`"),
    ],
)
def test_wrong_values_are_told(values: dict[str, str] | None, words: str) -> None:
    opening: list[Callable[[], object]] = [
        lambda: generated.Motor.test(set=values),
        lambda: scl.test(TOPOLOGY, "motor", set=values),
    ]
    for open_pair in opening:
        with pytest.raises(scl.OpenError) as error:
            open_pair()
        assert words in str(error.value)


def test_parameters_cannot_be_changed() -> None:
    controller, peer = generated.Controller.test()
    with controller, peer:
        with pytest.raises(dataclasses.FrozenInstanceError):
            controller.parameters.gain = 1.0
        with pytest.raises(AttributeError):
            controller.parameters = None
        with pytest.raises(scl.UnknownGate, match="did you mean `parameters`"):
            controller.parametres  # noqa: B018
    dynamic, peer = scl.test(TOPOLOGY, "controller")
    with dynamic, peer:
        with pytest.raises(TypeError):
            dynamic.parameters["gain"] = 1.0
        with pytest.raises(AttributeError):
            dynamic.parameters = None
        assert "gain: f64" in pydoc.plain(pydoc.render_doc(dynamic))
        assert "mode: one of `manual` and `auto`" in pydoc.plain(pydoc.render_doc(dynamic))


def test_live_parameters_are_taken_over() -> None:
    controller, peer = generated.Controller.test()
    with controller, peer:
        before = controller.parameters
        assert not controller.update_parameters()
        controller.set_parameter("gain", "2.5")
        controller.set_parameter("mode", "auto")
        assert controller.parameters is before
        assert controller.update_parameters()
        assert not controller.update_parameters()
        found = controller.parameters
        assert (found.gain, found.mode, found.ratio) == (2.5, generated.ControllerMode.AUTO, 0.5)
        assert before.gain == 0.8
    with pytest.raises(scl.Closed):
        controller.update_parameters()
    dynamic, peer = scl.test(TOPOLOGY, "controller")
    with dynamic, peer:
        dynamic.set_parameter("names", "[a]")
        assert dynamic.update_parameters()
        assert dynamic.parameters["names"] == ["a"]


def test_a_program_waits_for_a_change() -> None:
    controller, peer = generated.Controller.test()
    with controller, peer:
        assert not controller.update_parameters(timeout=0.001)
        setter = threading.Thread(target=controller.set_parameter, args=("gain", "2"))
        setter.start()
        assert controller.update_parameters(timeout=None)
        assert controller.parameters.gain == 2
        setter.join()


def test_waiting_for_a_change_ends_with_the_component() -> None:
    controller, peer = generated.Controller.test()
    closer = threading.Thread(target=controller.close)
    with controller, peer:
        closer.start()
        with pytest.raises(scl.Closed):
            controller.update_parameters(timeout=None)
    closer.join()


def test_a_task_waits_for_a_change() -> None:
    async def changes() -> list[float]:
        controller, peer = generated.Controller.test()
        with controller, peer:
            # A task that is cancelled takes nothing.
            cancelled = asyncio.create_task(controller.parameters_changed())
            await asyncio.sleep(0)
            cancelled.cancel()
            with pytest.raises(asyncio.CancelledError):
                await cancelled
            waiting = asyncio.create_task(controller.parameters_changed())
            await asyncio.sleep(0)
            controller.set_parameter("gain", "2")
            await waiting
            found = [controller.parameters.gain]
            # What has changed before is not waited for.
            controller.set_parameter("gain", "3")
            await controller.parameters_changed()
            return [*found, controller.parameters.gain]

    assert asyncio.run(changes()) == [2, 3]


@pytest.mark.parametrize(
    "name, value, words",
    [
        ("gian", "1", "component `controller` has no parameter `gian`; did you mean `gain`?"),
        ("u8", "1", "parameter `controller.u8` is fixed while its program runs"),
        ("gain", "11", "parameter `controller.gain` cannot have this value: `11` is not from 0 to 10"),
    ],
)
def test_what_cannot_be_set_is_told(name: str, value: str, words: str) -> None:
    controller, peer = generated.Controller.test()
    with controller, peer:
        with pytest.raises(ValueError) as error:
            controller.set_parameter(name, value)
        assert words in str(error.value)
        assert not controller.update_parameters()


def test_a_component_without_parameters_has_none() -> None:
    plain, peer = generated.Plain.test()
    with plain, peer:
        assert not hasattr(plain, "parameters")
