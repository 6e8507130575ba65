"""Keeps the parameters of all components: publishes them, answers changes, and keeps changes in a file."""

import argparse
import sys
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

import scl

import parameter_file
import parameters
from arcade_scl import Configuration, Parameter, ParameterChange, ParameterResult, Parameters


class Store:
    """The values in effect. With a file, a change is in effect once it has been written."""

    def __init__(self, file: Path | None) -> None:
        self.file = file
        self.values: Mapping[str, float] = {**parameters.DEFAULTS, **(parameter_file.read(file) if file else {})}

    def change(self, name: str, value: float) -> str | None:
        """Sets a parameter. Returns the reason if it cannot."""
        if problem := parameters.mistake(name, value):
            return problem
        changed = {**self.values, name: value}
        try:
            if self.file:
                parameter_file.write(self.file, changed)
        except OSError as error:
            return f"cannot write {self.file}: {error.strerror}; `{name}` is still {self.values[name]:g}"
        self.values = changed
        return None

    def message(self) -> Parameters:
        return Parameters(parameters=[Parameter(name=name, value=value) for name, value in self.values.items()])


def run(component: Configuration, store: Store) -> None:
    changed = sum(value != parameters.DEFAULTS[name] for name, value in store.values.items())
    print(f"{len(store.values)} parameters, {changed} differ from their defaults")
    # The gate is latched: components that start later get it, too.
    component.parameters.send(store.message())
    while True:
        answer(component, store)


def answer(component: Configuration, store: Store) -> None:
    request = component.control.try_recv()
    if request is None:
        # What had arrived could not be decoded.
        return
    change: ParameterChange = request.message
    refused = store.change(change.name, change.value)
    if refused:
        print(f"refused: {refused}")
    else:
        print(f"{change.name} is now {change.value:g}")
        # Before the reply, so that the requester finds the value in effect.
        component.parameters.send(store.message())
    # A requester that has gone no longer waits for the reply.
    with suppress(scl.RequesterGone):
        request.reply(ParameterResult(accepted=refused is None, reason=refused or ""))


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--file", type=Path, metavar="PARAMETERS.YAML", help="keep changed parameters in this file")
    try:
        store = Store(arguments.parse_args().file)
    except parameter_file.FileMistakes as mistakes:
        print("\n".join(f"error: {line}" for line in str(mistakes).splitlines()), file=sys.stderr)
        return 2
    with Configuration() as component:
        run(component, store)
    return 0


if __name__ == "__main__":
    sys.exit(main())
