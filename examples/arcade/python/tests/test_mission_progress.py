"""Decisions of a mission, by the messages that it receives."""

import pytest

from arcade_scl import Action, Arbitration, Authority, CommandResult, Flight, Mode, Vector
from mission_plan import plan
from mission_progress import Decision, Progress
from mission_script import parse

MISSION = "name: x\nsteps: [take_off: {height: 5}, go_to: {east: 3, north: 4, height: 5}, hold: 2s, land: {}]"
SAFETY = Arbitration(authority=Authority.AUTHORITY_SAFETY, reason="power is low")
GROUND = Arbitration(authority=Authority.AUTHORITY_GROUND)


def flight(
    seconds: float,
    command_id: int,
    *position: float,
    mode: Mode = Mode.MODE_FLYING,
    valid: bool = True,
) -> Flight:
    x, y, z = position or (0.0, 0.0, 0.0)
    return Flight(
        time_us=round(seconds * 1e6),
        mode=mode,
        command_id=command_id,
        position=Vector(x=x, y=y, z=z),
        position_valid=valid,
    )


def grounded(seconds: float, command_id: int) -> Flight:
    return flight(seconds, command_id, mode=Mode.MODE_GROUNDED)


def resumed(command_id: int, *position: float) -> Progress:
    """The progress of a mission that begins while this command is in effect, at 100 s."""
    progress = Progress(plan(parse(MISSION)))
    assert progress.update(flight(100, command_id, *position), None).command is None
    return progress


def test_a_mission_from_the_first_step_to_the_last() -> None:
    progress = Progress(plan(parse(MISSION)))
    first = progress.update(grounded(10, 0), None)
    assert first.lines == ["step 1 of 4: take off to 5 m"]
    assert first.command is not None
    assert first.command.action == Action.ACTION_TAKE_OFF
    progress.answered(CommandResult(accepted=True), 10_000_000)
    assert progress.update(grounded(10.1, 100), None) == Decision()
    assert progress.update(flight(14, 100, 0, 0, 4.7), None) == Decision()
    second = progress.update(flight(15, 100, 0, 0, 5.1), None)
    assert second.lines == ["step 2 of 4: go to east 3, north 4, height 5 m"]
    assert second.command is not None
    assert second.command.id == 101
    assert progress.update(flight(16, 101, 3, 4, 5), None) == Decision()
    third = progress.update(flight(17, 101, 3, 4, 5), None)
    assert third.lines == ["step 3 of 4: hold for 2 s"]
    assert third.command is not None
    assert progress.update(flight(17.1, 102, 3, 4, 5), None) == Decision()
    last = progress.update(flight(19.1, 102, 3, 4, 5), None)
    assert last.lines == ["step 4 of 4: land"]
    landing = flight(20, 103, 3, 4, 1, mode=Mode.MODE_LANDING)
    assert progress.update(landing, None) == Decision()
    landed = flight(25, 103, 3, 4, 0, mode=Mode.MODE_GROUNDED)
    assert progress.update(landed, None) == Decision(["mission complete, 5.00 m from home"], exit_code=0)


def test_flying_past_a_waypoint_does_not_reach_it() -> None:
    progress = resumed(101, 0, 0, 5)
    for seconds, east in [(101.0, 2.9), (101.5, 3.3), (101.9, 3.5), (102.1, 3.0), (103.0, 3.0)]:
        assert progress.update(flight(seconds, 101, east, 4, 5), None) == Decision()
    assert progress.update(flight(103.1, 101, 3, 4, 5), None).lines != []


def test_a_position_that_is_not_valid_reaches_nothing() -> None:
    progress = resumed(101, 0, 0, 5)
    for seconds in [101, 102, 103]:
        assert progress.update(flight(seconds, 101, 3, 4, 5, valid=False), None) == Decision()


def test_a_refused_command_is_repeated_and_its_reason_told_once() -> None:
    progress = Progress(plan(parse(MISSION)))
    sent = []
    lines = []
    for tenth in range(45):
        decision = progress.update(grounded(tenth / 10, 0), None)
        if decision.command:
            sent.append(tenth)
            lines += progress.answered(CommandResult(reason="no fix"), tenth * 100_000).lines
    assert sent == [0, 20, 40]
    assert lines == ["refused: no fix; trying again"]


def test_a_command_that_was_accepted_and_lost_is_repeated() -> None:
    progress = Progress(plan(parse(MISSION)))
    assert progress.update(grounded(0, 0), None).command is not None
    progress.answered(CommandResult(accepted=True), 0)
    assert progress.update(grounded(1.9, 0), None).command is None
    assert progress.update(grounded(2, 0), None).command is not None


@pytest.mark.parametrize(("command_id", "step"), [(100, "1 of 4: take off to 5 m"), (102, "3 of 4: hold for 2 s")])
def test_a_restarted_mission_resumes_at_its_step(command_id: int, step: str) -> None:
    progress = Progress(plan(parse(MISSION)))
    decision = progress.update(flight(50, command_id, 3, 4, 2), None)
    assert decision == Decision([f"resuming at step {step}"])


def test_a_restarted_mission_that_has_landed_is_complete() -> None:
    decision = Progress(plan(parse(MISSION))).update(grounded(50, 103), None)
    assert decision == Decision(["resuming at step 4 of 4: land", "mission complete, 0.00 m from home"], exit_code=0)


@pytest.mark.parametrize(
    ("others", "line"),
    [
        (SAFETY, "waiting: safety commands the vehicle: power is low"),
        (GROUND, "waiting: the ground station commands the vehicle"),
    ],
)
def test_a_mission_waits_while_others_command(others: Arbitration, line: str) -> None:
    progress = resumed(101, 0, 0, 5)
    assert progress.update(flight(110, 101, 3, 4, 5), others) == Decision([line])
    # Even where its own waypoint is.
    assert progress.update(flight(112, 10_000, 3, 4, 5), others) == Decision()
    again = progress.update(flight(113, 10_000, 3, 4, 5), Arbitration())
    assert again.lines == ["continuing"]
    assert again.command is not None
    assert again.command.id == 101


@pytest.mark.parametrize("now", [SAFETY, Arbitration(reason="on the ground")])
def test_a_mission_ends_with_1_when_safety_has_landed_the_vehicle(now: Arbitration) -> None:
    progress = resumed(101, 0, 0, 5)
    progress.update(flight(110, 1_000_000, 0, 0, 5), SAFETY)
    decision = progress.update(grounded(120, 1_000_000), now)
    reason = "stopped at step 2: the vehicle is on the ground: safety commands the vehicle: power is low"
    assert decision == Decision([reason], exit_code=1)


def test_a_mission_ends_with_1_when_safety_lands_at_its_own_landing() -> None:
    progress = resumed(103, 0, 0, 5)
    decision = progress.update(grounded(120, 1_000_000), None)
    assert decision == Decision(["stopped at step 4: the vehicle is on the ground"], exit_code=1)


def test_a_mission_does_not_take_off_after_others_have_landed_the_vehicle() -> None:
    decision = Progress(plan(parse(MISSION))).update(grounded(120, 1_000_000), SAFETY)
    assert decision.exit_code == 1
    assert decision.command is None
    assert "on the ground after command 1000000, which is not a step of this mission" in decision.lines[0]


def test_a_mission_does_not_take_over_a_flight_of_others() -> None:
    progress = Progress(plan(parse(MISSION)))
    assert progress.update(flight(50, 10_000, 0, 0, 5), GROUND) == Decision()
    assert progress.update(flight(51, 10_000, 0, 0, 5), None).exit_code == 1


def test_holding_on_the_ground_sends_nothing() -> None:
    progress = Progress(plan(parse("name: bench\nsteps: [hold: 2s]")))
    assert progress.update(grounded(5, 0), None) == Decision(["step 1 of 1: hold for 2 s"])
    assert progress.update(grounded(6.9, 0), None) == Decision()
    assert progress.update(grounded(7, 0), None) == Decision(["mission complete"], exit_code=0)
