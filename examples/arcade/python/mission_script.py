"""Reads a mission script, a YAML file with a list of steps, and reports every mistake with its line."""

import difflib
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import yaml


@dataclass(frozen=True)
class TakeOff:
    """Climbs straight up."""

    height: float  # m above home


@dataclass(frozen=True)
class GoTo:
    """Flies to a waypoint."""

    east: float  # m from home
    north: float  # m from home
    height: float  # m above home
    yaw: float | None = None  # degrees counter-clockwise from east; None keeps the last one
    speed: float | None = None  # m/s; None is the limit of `configuration`


@dataclass(frozen=True)
class Hold:
    """Stays where it is."""

    seconds: float


@dataclass(frozen=True)
class Return:
    """Flies to the point above home, at the height of the step before."""


@dataclass(frozen=True)
class Land:
    """Descends straight down and switches the motors off."""


Task = TakeOff | GoTo | Hold | Return | Land


@dataclass(frozen=True)
class Step:
    line: int
    task: Task


@dataclass(frozen=True)
class Mission:
    file: str
    name: str
    steps: tuple[Step, ...]


class ScriptError(Exception):
    """All mistakes of a script, one per line of text."""


@dataclass(frozen=True)
class Key:
    """What a key of a command may be."""

    unit: str
    required: bool = True
    above: float = -math.inf


COMMANDS: dict[str, tuple[type[TakeOff | GoTo | Return | Land], dict[str, Key]]] = {
    "take_off": (TakeOff, {"height": Key("m", above=0)}),
    "go_to": (
        GoTo,
        {
            "east": Key("m"),
            "north": Key("m"),
            "height": Key("m", above=0),
            "yaw": Key("degrees", required=False),
            "speed": Key("m/s", required=False, above=0),
        },
    ),
    "return": (Return, {}),
    "land": (Land, {}),
}
HOLD = "hold"  # the one command whose value is a time
SECONDS = {"ms": 1e-3, "s": 1.0, "min": 60.0}
# YAML 1.1 also reads `010` as 8 and `1:30` as 90; a script has decimal numbers only.
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


def read(file: Path) -> Mission:
    """Reads the script. Raises `ScriptError` with all mistakes, or `OSError`."""
    try:
        text = file.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise ScriptError(f"{file}: not a text file (byte {error.start} is not UTF-8)") from None
    return parse(text, str(file))


def parse(text: str, file: str = "mission.yaml") -> Mission:
    """Reads the text of a script. Raises `ScriptError` with all mistakes."""
    try:
        root = yaml.compose(text, Loader=yaml.SafeLoader)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = mark.line + 1 if mark else 1
        raise ScriptError(f"{file}:{line}: not valid YAML: {error.problem}") from None
    except yaml.YAMLError as error:
        raise ScriptError(f"{file}: not valid YAML: {' '.join(str(error).split())}") from None
    except RecursionError:
        raise ScriptError(f"{file}: not a mission: nested too deeply") from None
    reader = Reader(file)
    mission = reader.mission(root)
    if reader.mistakes or mission is None:
        raise ScriptError("\n".join(reader.mistakes))
    return mission


@dataclass
class Reader:
    """Turns YAML nodes, which know their lines, into a mission, and collects mistakes."""

    file: str
    mistakes: list[str] = field(default_factory=list)

    def mission(self, root: yaml.Node | None) -> Mission | None:
        if root is None:
            self.mistakes.append(f"{self.file}: empty; a mission has a `name` and `steps`")
            return None
        if not isinstance(root, yaml.MappingNode):
            self.mistake(root, "a mission is a mapping with `name` and `steps`")
            return None
        top = self.mapping(root, "the mission", {"name": True, "steps": True})
        name, steps = top.get("name"), top.get("steps")
        if name is not None and not (isinstance(name, yaml.ScalarNode) and name.value):
            self.mistake(name, "`name` is a text")
        if steps is None:
            return None
        if not isinstance(steps, yaml.SequenceNode) or not steps.value:
            self.mistake(steps, "`steps` is a list with at least one step, such as `- take_off: {height: 5}`")
            return None
        found = [self.step(number, node) for number, node in enumerate(steps.value, start=1)]
        complete = tuple(step for step in found if step is not None)
        # The order is judged only if all steps are known, so that one mistake is not reported twice.
        if len(complete) == len(found):
            self.mistakes.extend(wrong_order(self.file, complete))
        return Mission(self.file, name.value if isinstance(name, yaml.ScalarNode) else "", complete)

    def step(self, number: int, node: yaml.Node) -> Step | None:
        what = f"step {number}"
        if not isinstance(node, yaml.MappingNode) or len(node.value) != 1:
            self.mistake(node, f"{what}: a step is one command, such as `go_to: {{east: 10, north: 0, height: 5}}`")
            return None
        key, value = node.value[0]
        command = key.value if isinstance(key, yaml.ScalarNode) else ""
        if command == HOLD:
            seconds = self.duration(value, f"{what}: `{HOLD}`")
            return None if seconds is None else Step(line(node), Hold(seconds))
        if command not in COMMANDS:
            self.mistake(key, f"{what}: unknown command `{command}`{suggestion(command, [*COMMANDS, HOLD])}")
            return None
        task, keys = COMMANDS[command]
        what = f"{what}: `{command}`"
        if not isinstance(value, yaml.MappingNode):
            self.mistake(value, f"{what} takes a mapping: `{command}: {{{', '.join(f'{key}: ...' for key in keys)}}}`")
            return None
        before = len(self.mistakes)
        nodes = self.mapping(value, what, {key: spec.required for key, spec in keys.items()})
        numbers = {key: self.number(node, f"{what}: `{key}`", keys[key]) for key, node in nodes.items()}
        return Step(line(node), task(**numbers)) if len(self.mistakes) == before else None

    def mapping(self, node: yaml.MappingNode, what: str, keys: dict[str, bool]) -> dict[str, yaml.Node]:
        """The values by their keys, which `keys` lists with whether they are required."""
        found: dict[str, yaml.Node] = {}
        for key, value in node.value:
            name = key.value if isinstance(key, yaml.ScalarNode) else str(key.tag)
            if name not in keys:
                self.mistake(key, f"{what}: unknown key `{name}`{suggestion(name, list(keys))}")
            elif name in found:
                self.mistake(key, f"{what}: `{name}` is given twice")
            else:
                found[name] = value
        missing = [f"`{key}`" for key, required in keys.items() if required and key not in found]
        if missing:
            self.mistake(node, f"{what}: missing {', '.join(missing)}")
        return found

    def number(self, node: yaml.Node, what: str, key: Key) -> float:
        text = node.value.strip() if isinstance(node, yaml.ScalarNode) else ""
        value = float(text) if NUMBER.fullmatch(text) else math.nan
        if not math.isfinite(value):
            problem = f": `{text}` is not a finite number" if text else " is not a number"
            self.mistake(node, f"{what}{problem}; give {key.unit}, without the unit")
        elif value <= key.above:
            self.mistake(node, f"{what}: {value:g} {key.unit} is not above {key.above:g}")
        return value

    def duration(self, node: yaml.Node, what: str) -> float | None:
        text = node.value.strip() if isinstance(node, yaml.ScalarNode) else ""
        number = NUMBER.match(text)
        unit = text[number.end() :].strip() if number else ""
        if number is None:
            self.mistake(node, f"{what} takes a time such as `3s`")
        elif unit not in SECONDS:
            given = f"unknown unit `{unit}`" if unit else f"`{text}` has no unit"
            self.mistake(node, f"{what}: {given}; units are {', '.join(f'`{unit}`' for unit in SECONDS)}")
        elif not 0 <= (seconds := float(number.group()) * SECONDS[unit]) < math.inf:
            self.mistake(node, f"{what}: {text} is not a time")
        else:
            return seconds
        return None

    def mistake(self, node: yaml.Node, text: str) -> None:
        self.mistakes.append(f"{self.file}:{line(node)}: {text}")


def wrong_order(file: str, steps: tuple[Step, ...]) -> Iterator[str]:
    """Steps that make no sense where they are: flying before a take-off, or ending in the air."""
    in_air = False
    for number, step in enumerate(steps, start=1):
        match step.task:
            case TakeOff() if in_air:
                yield f"{file}:{step.line}: step {number}: `take_off` in the air; `land` must come before it"
            case GoTo() | Return() | Land() if not in_air:
                yield f"{file}:{step.line}: step {number}: the vehicle is on the ground; `take_off` must come before it"
                return
        in_air = in_air and not isinstance(step.task, Land) or isinstance(step.task, TakeOff)
    if in_air:
        yield f"{file}:{steps[-1].line}: step {len(steps)}: the mission ends in the air; `land: {{}}` must come last"


def suggestion(word: str, known: list[str]) -> str:
    if not known:
        return "; it takes none"
    close = difflib.get_close_matches(word, known, n=1)
    return f"; did you mean `{close[0]}`?" if close else f"; known are {', '.join(f'`{one}`' for one in known)}"


def line(node: yaml.Node) -> int:
    return int(node.start_mark.line) + 1
