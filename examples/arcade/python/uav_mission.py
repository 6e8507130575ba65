"""Flies a mission from a script: sends each step to the arbiter and waits until it is reached."""

import argparse
import sys
from pathlib import Path

import scl

from arcade_scl import Arbitration, Command, CommandResult, UavMission
from black_box import BlackBox
from gates import next_within
from mission_plan import Leg, outside, plan, too_long
from mission_progress import Decision, Progress
from mission_script import Mission, ScriptError, read

SILENCE = 3.0  # s without a message until the program says what it waits for


def run(component: UavMission, mission: Mission) -> int:
    """Flies the mission and returns the exit code."""
    black_box = BlackBox(component.records, "uav_mission")
    legs = plan(mission)
    progress = Progress(legs)
    arbitration: Arbitration | None = None
    while True:
        flight = next_within(component.flight, SILENCE)
        if flight is None:
            black_box.note("waiting for the autopilot")
            continue
        if progress.index is None and flight.command_id == 0:
            problems = before_take_off(component, legs, mission.file)
            for problem in problems:
                black_box.note(f"error: {problem}")
            if problems:
                return 1
        arbitration = component.arbitration.latest() or arbitration
        decision = progress.update(flight, arbitration)
        say(black_box, decision)
        if decision.exit_code is not None:
            return decision.exit_code
        if decision.command is not None:
            say(black_box, progress.answered(ask(component, decision.command), flight.time_us))


def say(black_box: BlackBox, decision: Decision) -> None:
    for line in decision.lines:
        black_box.note(line)


def before_take_off(component: UavMission, legs: list[Leg], file: str) -> list[str]:
    """Waits for the limits and the battery, and returns why the mission cannot be flown."""
    if all(leg.command is None for leg in legs):
        return []
    while (limits := next_within(component.limits, SILENCE)) is None:
        print("waiting for the limits", flush=True)
    while (power := next_within(component.power, SILENCE)) is None:
        print("waiting for power management", flush=True)
    component.update_parameters()
    return outside(legs, limits, file) + too_long(legs, limits, power, component.parameters.hover_current)


def ask(component: UavMission, command: Command) -> CommandResult:
    """The arbiter's answer. One that does not answer is like one that refuses: the command is repeated."""
    try:
        return component.arbiter.call(command)
    except (scl.Timeout, scl.PeerLost, scl.Refused, scl.DecodeError):
        return CommandResult(accepted=False, reason="the arbiter does not answer")


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("script", type=Path, help="the mission, such as missions/survey.yaml")
    script: Path = arguments.parse_args().script
    try:
        mission = read(script)
    except ScriptError as mistakes:
        print("\n".join(f"error: {mistake}" for mistake in str(mistakes).splitlines()), file=sys.stderr)
        return 2
    except OSError as error:
        print(f"error: cannot read the mission `{script}`: {error.strerror}", file=sys.stderr)
        return 2
    with UavMission() as component:
        return run(component, mission)


if __name__ == "__main__":
    sys.exit(main())
