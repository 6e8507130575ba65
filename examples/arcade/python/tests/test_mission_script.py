"""Mission scripts: what is read, and the text for each mistake."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from mission_script import GoTo, Hold, Land, Return, ScriptError, TakeOff, parse, read

MISSIONS = Path(__file__).parents[2] / "missions"
FLIGHT = "name: x\nsteps:\n- take_off: {height: 5}\n"  # a step that follows is on line 4


def mistakes(text: str) -> list[str]:
    with pytest.raises(ScriptError) as raised:
        parse(text, "m.yaml")
    return str(raised.value).splitlines()


def test_the_survey_is_read() -> None:
    tasks = [step.task for step in read(MISSIONS / "survey.yaml").steps]
    assert [type(task) for task in tasks] == [TakeOff, GoTo, GoTo, GoTo, Hold, GoTo, Return, Land]
    assert tasks[2] == GoTo(east=15, north=15, height=8, yaw=90, speed=None)
    assert tasks[4] == Hold(3.0)


def test_steps_know_their_lines() -> None:
    assert [step.line for step in parse(FLIGHT + "\n# nothing\n- land: {}").steps] == [3, 6]


def test_the_mission_on_the_ground_only_holds() -> None:
    assert {type(step.task) for step in read(MISSIONS / "ground.yaml").steps} == {Hold}


@pytest.mark.parametrize(("written", "seconds"), [("3s", 3), ("0.5 min", 30), ("250ms", 0.25), ('"1e1s"', 10)])
def test_times_have_units(written: str, seconds: float) -> None:
    assert parse(f"name: x\nsteps: [hold: {written}]").steps[0].task == Hold(seconds)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "m.yaml: empty; a mission has a `name` and `steps`"),
        ("# nothing", "m.yaml: empty; a mission has a `name` and `steps`"),
        ("- 1", "m.yaml:1: a mission is a mapping with `name` and `steps`"),
        ("name: x", "m.yaml:1: the mission: missing `steps`"),
        ("name: [x]\nsteps: [hold: 1s]", "m.yaml:1: `name` is a text"),
        ("steps: [hold: 1s]", "m.yaml:1: the mission: missing `name`"),
        (
            "name: x\nsteps: []",
            "m.yaml:2: `steps` is a list with at least one step, such as `- take_off: {height: 5}`",
        ),
        ("name: x\nname: y\nsteps: [hold: 1s]", "m.yaml:2: the mission: `name` is given twice"),
        ("name: x\nstep: 1\nsteps: [hold: 1s]", "m.yaml:2: the mission: unknown key `step`; did you mean `steps`?"),
        ("name: [", "m.yaml:1: not valid YAML: expected the node content, but found '<stream end>'"),
        ("name: x\n---\nname: y", "m.yaml:2: not valid YAML: but found another document"),
        ("[" * 9999, "m.yaml: not a mission: nested too deeply"),
    ],
)
def test_mistakes_of_the_file(text: str, expected: str) -> None:
    assert mistakes(text) == [expected]


@pytest.mark.parametrize(
    ("step", "expected"),
    [
        ("goto: {}", "unknown command `goto`; did you mean `go_to`?"),
        ("dance: {}", "unknown command `dance`; known are `take_off`, `go_to`, `return`, `land`, `hold`"),
        ("land", "a step is one command, such as `go_to: {east: 10, north: 0, height: 5}`"),
        ("{land: {}, hold: 1s}", "a step is one command, such as `go_to: {east: 10, north: 0, height: 5}`"),
        ("land:", "`land` takes a mapping: `land: {}`"),
        ("take_off: 5", "`take_off` takes a mapping: `take_off: {height: ...}`"),
        ("go_to: {east: 1, height: 5}", "`go_to`: missing `north`"),
        ("take_off: {hight: 5, height: 5}", "`take_off`: unknown key `hight`; did you mean `height`?"),
        ("land: {height: 5}", "`land`: unknown key `height`; it takes none"),
        ("take_off: {height: .nan}", "`take_off`: `height`: `.nan` is not a finite number; give m, without the unit"),
        ("take_off: {height: 1e999}", "`take_off`: `height`: `1e999` is not a finite number; give m, without the unit"),
        ("take_off: {height: 5m}", "`take_off`: `height`: `5m` is not a finite number; give m, without the unit"),
        ("take_off: {height: [5]}", "`take_off`: `height` is not a number; give m, without the unit"),
        ("take_off: {height: yes}", "`take_off`: `height`: `yes` is not a finite number; give m, without the unit"),
        ("take_off: {height: 0}", "`take_off`: `height`: 0 m is not above 0"),
        ("go_to: {east: 1, north: 1, height: 5, speed: -1}", "`go_to`: `speed`: -1 m/s is not above 0"),
        ("hold: 3", "`hold`: `3` has no unit; units are `ms`, `s`, `min`"),
        ("hold: 3h", "`hold`: unknown unit `h`; units are `ms`, `s`, `min`"),
        ("hold: -3s", "`hold`: -3s is not a time"),
        ("hold: .nan", "`hold` takes a time such as `3s`"),
        ("hold: {}", "`hold` takes a time such as `3s`"),
    ],
)
def test_mistakes_of_a_step(step: str, expected: str) -> None:
    assert mistakes(f"{FLIGHT}- {step}") == [f"m.yaml:4: step 2: {expected}"]


@pytest.mark.parametrize(
    ("steps", "expected"),
    [
        (
            "[go_to: {east: 1, north: 1, height: 5}]",
            "step 1: the vehicle is on the ground; `take_off` must come before it",
        ),
        ("[return: {}]", "step 1: the vehicle is on the ground; `take_off` must come before it"),
        ("[take_off: {height: 5}]", "step 1: the mission ends in the air; `land: {}` must come last"),
        (
            "[take_off: {height: 5}, take_off: {height: 6}, land: {}]",
            "step 2: `take_off` in the air; `land` must come before it",
        ),
    ],
)
def test_steps_in_the_wrong_order(steps: str, expected: str) -> None:
    assert mistakes(f"name: x\nsteps: {steps}") == [f"m.yaml:2: {expected}"]


def test_all_mistakes_are_told_at_once() -> None:
    assert len(mistakes(f"{FLIGHT}- goto: {{}}\n- hold: 3\n- land: {{now: 1}}\n")) == 3


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (b"\xff\xfe\x00", "not a text file (byte 0 is not UTF-8)"),
        (b"name: \x00", "not valid YAML: unacceptable character"),
        (b"name: x\nsteps: [fly: {}]", "unknown command `fly`"),
    ],
)
def test_the_program_ends_with_2(
    run_program: Callable[..., "subprocess.CompletedProcess[str]"], tmp_path: Path, content: bytes, expected: str
) -> None:
    script = tmp_path / "mission.yaml"
    script.write_bytes(content)
    ended = run_program("uav_mission.py", str(script))
    assert ended.returncode == 2
    assert ended.stderr.startswith(f"error: {script}:")
    assert expected in ended.stderr
    assert "Traceback" not in ended.stderr


def test_a_script_that_is_missing_is_named(run_program: Callable[..., "subprocess.CompletedProcess[str]"]) -> None:
    ended = run_program("uav_mission.py", "nowhere.yaml")
    assert ended.returncode == 2
    assert ended.stderr == "error: cannot read the mission `nowhere.yaml`: No such file or directory\n"
