"""Plays `left` or `right` of `topologies/matrix/matrix.yaml` with the generated module: `main.py COMPONENT`, or, with
the plan of another topology, `main.py COMPONENT PLAN_FILE`. The commands are those of all programs in `languages`.
"""

import sys
import time
from pathlib import Path
from typing import Any

from matrix_scl import Left, Right, Sample

import scl

REPLY = 1000


def text(number: int) -> str:
    return f"sample {number} ü"


def message(name: str, number: int) -> Any:
    return text(number).encode() if name.endswith("_bytes") else Sample(number=number, text=text(number))


def number_of(received: Any) -> int:
    if isinstance(received, bytes):
        number, found = int(received.split()[1]), received.decode()
    else:
        number, found = received.number, received.text
    assert found == text(number), received
    return number


def ranges(numbers: list[int]) -> str:
    merged: list[list[int]] = []
    for number in numbers:
        if merged and merged[-1][1] == number:
            merged[-1][1] += 1
        else:
            merged.append([number, number + 1])
    return " ".join(f"{first}..{end}" for first, end in merged)


def say(line: str) -> None:
    print(line, flush=True)


def account(gate: scl.Gate) -> str:
    stats = gate.stats()
    return f"{stats['sent']} {stats['received']} {stats['rejected']}"


def age_of(gate: Any) -> str:
    """Whether the last message is latched. Its age is an hour at most, in the right unit."""
    age = gate.latched_age
    if age is None:
        return "new"
    return "latched" if 0 < age < 3600 else f"{age} s old"


def ready(component: scl.Component, millis: str) -> str:
    try:
        component.ready(timeout=int(millis) / 1000)
    except scl.NotReady as error:
        return "error: " + str(error).replace("\n", " ")
    return "ready"


def take(gate: Any, serves: bool) -> int | None:
    try:
        received = gate.recv()
    except scl.DecodeError:
        say("undecodable")
        return None
    if not serves:
        return number_of(received)
    number = number_of(received.message)
    received.reply(message(gate.name, number + REPLY))
    return number


def follow(component: scl.Component, command: str, name: str = "", *words: str) -> str:
    if command == "ready":
        return ready(component, name)
    gate: Any = getattr(component, name)
    numbers = [int(word) for word in words]
    match command:
        case "send":
            for number in range(*numbers):
                gate.send(message(name, number))
            return "sent"
        case "call":
            return ranges([number_of(gate.call(message(name, number))) for number in range(*numbers)])
        case "gone":
            while gate.is_connected:
                time.sleep(0.001)
            return "gone"
        case "take" | "serve":
            taken = [take(gate, command == "serve") for _ in range(numbers[0])]
            return ranges([number for number in taken if number is not None])
        case "age":
            return age_of(gate)
        case _:
            return account(gate)


def opened() -> scl.Component:
    if len(sys.argv) > 2:
        return scl.Component(Path(sys.argv[2]).read_text(), sys.argv[1])
    return Left() if sys.argv[1] == "left" else Right()


with opened() as played:
    say("open")
    for line in sys.stdin:
        say(follow(played, *line.split()))
