"""The arbiter beside the other ends of its gates: a thread stands for the autopilot where it has to answer."""

import asyncio
from collections.abc import Iterator

import pytest

from arbiter_logic import LEAD_US
from arbiter_world import command
from arcade_scl import Action as Order
from arcade_scl import (
    Arbitration,
    Authority,
    Command,
    CommandResult,
    Flight,
    MissionArbiter,
    MissionArbiterPeer,
    Mode,
    Power,
    PowerLevel,
    Vector,
)
from command_ids import HOME, LANDING
from conftest import HANG_LIMIT, Background, running, until
from defaults import limits
from mission_arbiter import Program

FLYING = Flight(
    time_us=10_000_000, mode=Mode.MODE_FLYING, command_id=100, position_valid=True, position=Vector(x=9, z=5)
)
FULL = Power(charge_left=0.9, level=PowerLevel.POWER_LEVEL_OK)


@pytest.fixture
def peer() -> Iterator[MissionArbiterPeer]:
    component, peer = MissionArbiter.test()
    with running(component, lambda: asyncio.run(Program(component).run())):
        yield peer
        peer.close(0)


def fly(peer: MissionArbiterPeer, flight: Flight, authority: Authority) -> None:
    """Waits until the arbiter knows of it."""
    peer.limits.send(limits())
    peer.power.send(FULL)
    peer.flight.send(flight)
    arbitration(peer, authority, flight.time_us)


def arbitration(peer: MissionArbiterPeer, authority: Authority, time_us: int = 0) -> Arbitration:
    def wanted(message: Arbitration) -> bool:
        return message.authority == authority and message.time_us >= time_us

    return until(lambda: peer.arbitration.recv(timeout=HANG_LIMIT), wanted)


def test_a_request_reaches_the_autopilot_and_the_answer_comes_back(peer: MissionArbiterPeer) -> None:
    fly(peer, FLYING, Authority.AUTHORITY_MISSION)
    asked: list[Command] = []

    def autopilot() -> None:
        for request in peer.autopilot:
            asked.append(request.message)
            request.reply(CommandResult(accepted=False, reason="too cold"))

    Background(autopilot)
    result = peer.mission.call(command(Order.ACTION_GO_TO, 101, 20, 30, 5), timeout=HANG_LIMIT)
    assert result == CommandResult(accepted=False, reason="too cold")
    assert (asked[0].id, asked[0].target.y) == (101, 30)
    assert asked[0].effective_us == FLYING.time_us + LEAD_US


def test_an_unknown_action_is_refused_without_the_autopilot(peer: MissionArbiterPeer) -> None:
    fly(peer, FLYING, Authority.AUTHORITY_MISSION)
    unknown = Command.FromString(b"\x08\x65\x10\x4d")
    result = peer.ground.call(unknown, timeout=HANG_LIMIT)
    assert result.reason == "command id 101 is not one of the ground station; those are 10000 to 999999"
    result = peer.mission.call(unknown, timeout=HANG_LIMIT)
    assert result.reason == "unknown action 77; known are take off, go to, land, return"
    assert peer.autopilot.try_recv() is None


def test_a_silent_autopilot_ends_in_a_refusal(peer: MissionArbiterPeer) -> None:
    fly(peer, FLYING, Authority.AUTHORITY_MISSION)
    result = peer.mission.call(command(Order.ACTION_GO_TO, 101, 20, 30, 5), timeout=HANG_LIMIT)
    assert result.reason.startswith("the autopilot does not answer: gate `mission_arbiter.autopilot` got no reply")
    # It was asked more than once.
    assert peer.autopilot.try_recv() is not None and peer.autopilot.try_recv() is not None


def test_low_power_flies_home_and_lands(peer: MissionArbiterPeer) -> None:
    fly(peer, FLYING, Authority.AUTHORITY_MISSION)
    peer.power.send(Power(charge_left=0.28, level=PowerLevel.POWER_LEVEL_LOW))
    asked = peer.autopilot.recv(timeout=HANG_LIMIT)
    assert (asked.message.id, asked.message.action) == (HOME + 1_000_000, Order.ACTION_GO_TO)
    asked.reply(CommandResult(accepted=True))
    assert arbitration(peer, Authority.AUTHORITY_SAFETY).reason == "low power, 28 % left: returning home"
    texts = (peer.records.recv(timeout=HANG_LIMIT).text for _ in range(2))
    assert "safety decides: low power, 28 % left: returning home" in texts
    home = Flight(time_us=20_000_000, mode=Mode.MODE_FLYING, command_id=asked.message.id, position_valid=True)
    peer.flight.send(home)
    # A late answer to the first command would have it sent again.
    asked = until(lambda: peer.autopilot.recv(timeout=HANG_LIMIT), lambda it: it.message.id != home.command_id)
    assert (asked.message.id, asked.message.action) == (LANDING + 1_000_000, Order.ACTION_LAND)


def test_arbitration_goes_on_without_anybody(peer: MissionArbiterPeer) -> None:
    for _ in range(5):
        assert arbitration(peer, Authority.AUTHORITY_NOBODY).time_us == 0
    until(lambda: peer.arbitration.recv(timeout=HANG_LIMIT), lambda it: it.reason.startswith("the autopilot is silent"))
