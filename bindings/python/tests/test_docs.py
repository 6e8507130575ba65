"""The programs of docs/python.md run, beside a program that runs all other components."""

import re
import shutil
import signal
from pathlib import Path

import pytest
from conftest import Program, System

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs" / "python.md").read_text()
ALL = re.findall(r"^```python\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)
CONTROLS = [block for block in ALL if "controls_scl" in block]
BLOCKS = [block for block in ALL if block not in CONTROLS]
CLASSES = {
    "Sensor": "sensor",
    "Actuator": "actuator",
    "Controller": "controller",
    "UserInterface": "user_interface",
}

OTHERS = """
import sys, threading
from rover_scl import *

def sense():
    with Sensor() as sensor:
        while True:
            sensor.measurements.send(Measurement(speed=1.0), 0)
            ended.wait(0.001)

def act():
    with Actuator() as actuator:
        for setpoint in actuator.setpoint:
            pass

def control():
    with Controller() as controller:
        threading.Thread(target=steer, args=(controller,), daemon=True).start()
        for request in controller.commands:
            controller.events.send(Event(text="asked"))
            request.reply(Status(accepted=True))

def steer(controller):
    while True:
        controller.actuator.send(Setpoint(throttle=0.5))
        ended.wait(0.001)

def ask():
    with UserInterface() as ui:
        while True:
            try:
                ui.commands.call(Command(target_speed=1.0), timeout=0.1)
            except (TimeoutError, ConnectionError):
                pass

ended = threading.Event()
runs = {"sensor": sense, "actuator": act, "controller": control, "user_interface": ask}
for component, run in runs.items():
    if component != sys.argv[1]:
        threading.Thread(target=run, daemon=True).start()
print("open", flush=True)
ended.wait()
"""


def test_the_page_has_programs() -> None:
    assert len(BLOCKS) >= 8


@pytest.mark.parametrize("block", BLOCKS, ids=range(len(BLOCKS)))
def test_a_program_of_the_page_runs(system: System, tmp_path: Path, block: str) -> None:
    for file in ["examples/quickstart/topology.yaml", "examples/quickstart/rover.proto"]:
        shutil.copy(ROOT / file, tmp_path)
    shutil.copy(ROOT / "crates/scl-generate/tests/python/expected/rover_scl.py", tmp_path)
    others = _start(system, tmp_path, OTHERS, _component_of(block))
    others.expect("open")
    program = _start(system, tmp_path, block)
    # It ends by itself, or else when it is asked to.
    while program.process.poll() is None and not list(Path(system.folder).glob(f"rover/{_component_of(block)}.*")):
        pass
    if "while " in block or "for " in block:
        program.next_line() if "print(setpoint" in block else program.wait_until_asleep()
        program.send_signal(signal.SIGTERM)
    code, errors = program.end()
    assert (code, [line for line in errors.splitlines() if " scl" not in line]) == (0, [])


@pytest.mark.parametrize("block", CONTROLS, ids=range(len(CONTROLS)))
def test_a_program_with_parameters_runs(system: System, tmp_path: Path, block: str) -> None:
    shutil.copy(ROOT / "crates/scl-generate/tests/python/expected/controls_scl.py", tmp_path)
    code, errors = _start(system, tmp_path, block).end()
    assert (code, [line for line in errors.splitlines() if " scl" not in line]) == (0, [])


def _component_of(block: str) -> str:
    for name, component in CLASSES.items():
        if f'"{component}"' in block or f"{name}()" in block:
            return component
    raise AssertionError("which component is it?")


def _start(system: System, folder: Path, script: str, *arguments: str) -> Program:
    text = f"import os; os.chdir({str(folder)!r})\n{script}"
    return system.python(text, *arguments, PYTHONPATH=str(folder), PYTHONUNBUFFERED="1")
