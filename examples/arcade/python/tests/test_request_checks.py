"""Bad requests are refused with the reason, before the autopilot sees them."""

import math

import pytest

from arbiter_world import GROUND, MISSION, World, command
from arcade_scl import Action, Authority, Command, Flight, Mode, Power, PowerLevel, Vector
from defaults import limits
from request_checks import refusal

LIMITS = limits()
GROUNDED = Flight(mode=Mode.MODE_GROUNDED, position_valid=True)
FLYING = Flight(mode=Mode.MODE_FLYING, position_valid=True)
LOST = Flight(mode=Mode.MODE_FLYING, position_valid=False)
FULL = Power(charge_left=1.0, level=PowerLevel.POWER_LEVEL_OK)
LOW = Power(charge_left=0.2, level=PowerLevel.POWER_LEVEL_LOW)
TAKE_OFF, GO_TO, LAND, RETURN = Action.ACTION_TAKE_OFF, Action.ACTION_GO_TO, Action.ACTION_LAND, Action.ACTION_RETURN


@pytest.mark.parametrize(
    ("wanted", "flight", "power", "reason"),
    [
        (command(TAKE_OFF, 100, 0, 0, 5), GROUNDED, FULL, None),
        (command(TAKE_OFF, 100, 0, 0, 30), GROUNDED, FULL, None),
        (
            command(TAKE_OFF, 100, 0, 0, 31),
            GROUNDED,
            FULL,
            "a height of 31.0 m is outside of the fence, which is 0 to 30 m",
        ),
        (command(TAKE_OFF, 100, 0, 0, 0), GROUNDED, FULL, "a height of 0.0 m is outside"),
        (command(TAKE_OFF, 100), GROUNDED, FULL, "`take off` without a target"),
        (command(TAKE_OFF, 100, 0, 0, 5), FLYING, FULL, "the vehicle is in the air already"),
        (command(TAKE_OFF, 100, 0, 0, 5), GROUNDED, LOW, "only 20 % of the battery is left"),
        (command(TAKE_OFF, 100, 0, 0, 5), GROUNDED, None, "the battery's charge is unknown"),
        (command(GO_TO, 100, 60, 80, 5), FLYING, LOW, None),
        (
            command(GO_TO, 100, 61, 80, 5),
            FLYING,
            FULL,
            "100.6 m from home is outside of the fence, which has a radius of 100",
        ),
        (command(GO_TO, 100, 0, 0, 99), FLYING, FULL, "a height of 99.0 m is outside"),
        (command(GO_TO, 100, 0, 0, -1), FLYING, FULL, "a height of -1.0 m is outside"),
        (command(GO_TO, 100, math.nan, 0, 5), FLYING, FULL, "x is nan, which is not a finite number"),
        (command(GO_TO, 100, 0, 0, math.inf), FLYING, FULL, "z is inf, which is not a finite number"),
        (command(GO_TO, 100, 0, 0, 5, yaw=-math.inf), FLYING, FULL, "yaw is -inf"),
        (command(GO_TO, 100, 0, 0, 5, speed=math.nan), FLYING, FULL, "speed is nan"),
        (command(GO_TO, 100, 0, 0, 5, speed=-1), FLYING, FULL, "speed -1 m/s is negative"),
        (command(GO_TO, 100), FLYING, FULL, "`go to` without a target"),
        (command(GO_TO, 100, 0, 0, 5), GROUNDED, FULL, "the vehicle is on the ground; it has to take off first"),
        (command(GO_TO, 100, 0, 0, 5), LOST, FULL, "the position is unknown"),
        (command(LAND, 100), LOST, LOW, None),
        (command(LAND, 100), GROUNDED, None, None),
        (command(RETURN, 100), FLYING, LOW, None),
        (command(RETURN, 100), GROUNDED, FULL, "the vehicle is on the ground"),
        (command(RETURN, 100), LOST, FULL, "the position is unknown"),
        (
            command(Action.ACTION_UNKNOWN, 100),
            FLYING,
            FULL,
            "unknown action 0; known are take off, go to, land, return",
        ),
        (Command.FromString(b"\x08\x64\x10\x09"), FLYING, FULL, "unknown action 9"),
        (command(LAND, 0), FLYING, FULL, "command id 0 is not one of the mission; those are 1 to 9999"),
        (command(LAND, 1_000_000), FLYING, FULL, "command id 1000000 is not one of the mission"),
    ],
)
def test_requests(wanted: Command, flight: Flight, power: Power | None, reason: str | None) -> None:
    found = refusal(MISSION, wanted, flight, power, LIMITS)
    assert found is None if reason is None else (found or "").startswith(reason), found


def test_ids_of_the_ground_station() -> None:
    assert refusal(GROUND, command(LAND, 10_000), FLYING, FULL, LIMITS) is None
    words = "command id 100 is not one of the ground station; those are 10000 to 999999"
    assert refusal(GROUND, command(LAND, 100), FLYING, FULL, LIMITS) == words


def test_a_refused_request_does_not_reach_the_autopilot_and_changes_nothing() -> None:
    world = World().airborne()
    before = world.state
    number = world.request(MISSION, Command(id=101, action=GO_TO, target=Vector(x=500, y=0, z=5)))
    assert not world.replies[number].accepted
    assert world.asked == []
    assert world.state == before
    words = "refused to go to east 500.0, north 0.0, height 5.0 m for the mission: 500.0 m from home"
    assert world.said[-1].startswith(words)
    # Asked again and again, it is said once.
    said = len(world.said)
    world.request(MISSION, Command(id=101, action=GO_TO, target=Vector(x=500, y=0, z=5)))
    assert len(world.said) == said
    assert world.state[0] == Authority.AUTHORITY_MISSION
