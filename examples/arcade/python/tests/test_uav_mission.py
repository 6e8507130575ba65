"""The mission's program beside the other ends of its gates."""

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

import uav_mission
from arcade_scl import Action, Command, CommandResult, Flight, Mode, Power, UavMission, Vector
from defaults import limits
from mission_script import Mission, parse, read

HOP = parse("name: hop\nsteps: [take_off: {height: 5}, go_to: {east: 6, north: 8, height: 5}, land: {}]", "hop.yaml")
PACE = 0.001  # s between two messages of the vehicle; its own clock advances by 0.1 s


class Vehicle:
    """An arbiter and an autopilot that is wherever it was sent."""

    def __init__(self, mission: Mission) -> None:
        self.component, self.peer = UavMission.test()
        self.commands: list[Command] = []
        self.answers: Iterator[CommandResult] = iter(())  # the first ones; the others accept
        self.flight = Flight(time_us=5_000_000, position=Vector(), position_valid=True)
        self.exit_code: int | None = None

        def fly() -> None:
            self.exit_code = uav_mission.run(self.component, mission)

        self.thread = threading.Thread(target=fly)

    def run(self, power: Power | None = None, **changed: float) -> None:
        """Flies to the end of the mission."""
        self.peer.limits.send(limits(**changed))
        self.peer.power.send(power or Power(current=0.1, time_left=60_000))
        self.thread.start()
        while self.thread.is_alive():
            self.step()

    def records(self, count: int) -> list[str]:
        """The first records of the black box."""
        return [self.peer.records.recv(timeout=300).text for _ in range(count)]

    def step(self) -> None:
        self.flight.time_us += 100_000
        self.peer.flight.send(self.flight)
        if self.peer.wait(self.peer.arbiter, timeout=PACE):
            request = self.peer.arbiter.recv()
            self.commands.append(request.message)
            result = next(self.answers, CommandResult(accepted=True))
            if result.accepted:
                self.obey(request.message)
            request.reply(result)

    def obey(self, command: Command) -> None:
        landing = command.action == Action.ACTION_LAND
        self.flight.command_id = command.id
        self.flight.mode = Mode.MODE_GROUNDED if landing else Mode.MODE_FLYING
        self.flight.position.CopyFrom(command.target)


def test_the_survey_is_flown() -> None:
    vehicle = Vehicle(read(Path(__file__).parents[2] / "missions" / "survey.yaml"))
    vehicle.run()
    assert vehicle.exit_code == 0
    assert [command.id for command in vehicle.commands] == list(range(100, 108))
    records = vehicle.records(9)
    assert records[0] == "step 1 of 8: take off to 5 m"
    assert records[-1] == "mission complete, 0.00 m from home"


def test_a_restarted_mission_goes_on() -> None:
    vehicle = Vehicle(HOP)
    vehicle.flight.command_id, vehicle.flight.mode = 101, Mode.MODE_FLYING
    vehicle.flight.position.CopyFrom(Vector(x=6, y=8, z=5))
    # Neither the parameters nor the battery are asked for in the air.
    vehicle.run(power=Power())
    assert vehicle.records(1)[0] == "resuming at step 2 of 3: go to east 6, north 8, height 5 m"
    assert [command.id for command in vehicle.commands] == [102]
    assert vehicle.exit_code == 0


def test_a_refused_take_off_is_tried_again() -> None:
    vehicle = Vehicle(HOP)
    vehicle.answers = iter(3 * [CommandResult(reason="no fix")])
    vehicle.run()
    assert vehicle.exit_code == 0
    assert [command.id for command in vehicle.commands] == [100, 100, 100, 100, 101, 102]
    assert vehicle.records(3) == [
        "step 1 of 3: take off to 5 m",
        "refused: no fix; trying again",
        "step 2 of 3: go to east 6, north 8, height 5 m",
    ]


def test_an_arbiter_that_does_not_answer_is_asked_again() -> None:
    component, peer = UavMission.test()
    asked = CommandResult(reason="the arbiter does not answer")
    with component, peer:
        assert uav_mission.ask(component, Command(id=100)) == asked
        assert peer.arbiter.recv(timeout=300).message.id == 100


@pytest.mark.parametrize(
    ("power", "changed", "expected"),
    [
        (
            Power(current=12, time_left=600),
            {"fence_radius": 9.5},
            "error: hop.yaml:2: step 2: 10.0 m from home is outside of the fence (`fence_radius` is 9.5 m)",
        ),
        (
            Power(current=12, time_left=600),
            {"fence_height": 4.5},
            "error: hop.yaml:2: step 1: a height of 5 m is above the fence (`fence_height` is 4.5 m)",
        ),
        (Power(current=12, time_left=2), {}, "error: the battery is too small: the mission takes about "),
    ],
)
def test_what_cannot_be_flown_is_refused_before_take_off(
    power: Power, changed: dict[str, float], expected: str, capsys: pytest.CaptureFixture[str]
) -> None:
    vehicle = Vehicle(HOP)
    vehicle.run(power, **changed)
    assert vehicle.exit_code == 1
    assert vehicle.commands == []
    assert vehicle.records(1)[0].startswith(expected)
    assert capsys.readouterr().out.startswith(expected)
