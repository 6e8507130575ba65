"""Who commands: the mission, the ground station or safety."""

import pytest

from arbiter_events import LimitsSeen, Tick
from arbiter_logic import LEAD_US
from arbiter_world import ACCEPTED, GROUND, MISSION, SAFETY, World, command
from arcade_scl import Action as Order
from arcade_scl import Authority, CommandResult, Mode, PowerLevel
from command_ids import HOME, LANDING
from defaults import limits

LOW, CRITICAL = PowerLevel.POWER_LEVEL_LOW, PowerLevel.POWER_LEVEL_CRITICAL
NOBODY = Authority.AUTHORITY_NOBODY
NORTH = command(Order.ACTION_GO_TO, 101, 0, 20, 5)


def test_a_request_is_passed_on_and_the_reply_comes_back() -> None:
    world = World()
    number = world.request(MISSION, command(Order.ACTION_TAKE_OFF, 100, 0, 0, 5))
    [asked] = world.asked
    assert (asked.id, asked.action, asked.target.z) == (100, Order.ACTION_TAKE_OFF, 5)
    assert asked.effective_us == world.flight.time_us + LEAD_US
    assert world.replies == {}
    world.answer()
    assert world.replies == {number: ACCEPTED}
    assert world.state == (MISSION, "take off to 5.0 m")


def test_a_refusal_of_the_autopilot_comes_back() -> None:
    world = World()
    number = world.request(MISSION, command(Order.ACTION_TAKE_OFF, 100, 0, 0, 5))
    world.answer(CommandResult(accepted=False, reason="the motors are hot"))
    assert world.replies[number] == CommandResult(accepted=False, reason="the motors are hot")
    assert world.state == (NOBODY, "")


def test_the_ground_station_takes_over_until_the_landing() -> None:
    world = World().airborne()
    world.request(GROUND, command(Order.ACTION_GO_TO, 10_000, 5, 5, 5))
    world.obey(Mode.MODE_FLYING)
    assert world.state == (GROUND, "go to east 5.0, north 5.0, height 5.0 m")
    refused = world.request(MISSION, NORTH)
    assert world.replies[refused].reason.startswith("the ground station commands the vehicle: go to")
    world.request(GROUND, command(Order.ACTION_LAND, 10_001))
    world.obey(Mode.MODE_LANDING)
    world.fly(5.0, mode=Mode.MODE_GROUNDED)
    assert world.state == (NOBODY, "on the ground")
    assert world.said[-1] == "landed"


def test_the_ground_station_is_served_first() -> None:
    world = World().airborne()
    first = world.request(MISSION, NORTH)
    second = world.request(MISSION, command(Order.ACTION_GO_TO, 102, 1, 0, 5))
    ground = world.request(GROUND, command(Order.ACTION_GO_TO, 10_000, 5, 5, 5))
    world.answer()
    assert [asked.id for asked in world.asked] == [101, 10_000]
    world.answer()
    assert world.replies[first].accepted and world.replies[ground].accepted
    assert "the ground station commands" in world.replies[second].reason


def test_low_power_returns_home_and_lands() -> None:
    world = World().airborne(20, 10, 8)
    world.power(0.29, LOW)
    assert world.said == ["safety decides: low power, 29 % left: returning home"]
    [home] = world.asked
    assert (home.id, home.action) == (HOME + 1_000_000, Order.ACTION_GO_TO)
    assert (home.target.x, home.target.y, home.target.z) == (0, 0, 8)
    world.obey(Mode.MODE_FLYING)
    world.fly(3.0, position=(0.4, 0.4, 8))
    assert len(world.asked) == 1
    world.fly(0.1, position=(0.3, 0.3, 8))
    assert (world.asked[1].id, world.asked[1].action) == (LANDING + 1_000_000, Order.ACTION_LAND)
    world.obey(Mode.MODE_LANDING)
    # Blown away while it lands: it does not fly home again.
    world.fly(1.0, position=(2, 0, 4))
    world.fly(9.0, mode=Mode.MODE_GROUNDED)
    assert len(world.asked) == 2
    assert world.state == (NOBODY, "on the ground")


def test_a_return_keeps_above_obstacles_and_below_the_fence() -> None:
    for height, expected in [(1.0, 3.0), (12.0, 12.0), (33.0, 30.0)]:
        world = World().airborne(20, 10, height)
        if height < 30:
            world.power(0.29, LOW)
        assert world.asked[0].target.z == expected


def test_mission_and_ground_are_refused_once_safety_has_decided() -> None:
    world = World().airborne(20, 0, 5)
    world.power(0.29, LOW)
    for source, command_id in [(MISSION, 102), (GROUND, 10_000)]:
        number = world.request(source, command(Order.ACTION_GO_TO, command_id, 1, 1, 5))
        expected = "safety commands the vehicle: low power, 29 % left: returning home"
        assert world.replies[number].reason == expected
    assert world.state[0] == SAFETY


def test_critical_power_lands_here_also_during_a_return() -> None:
    world = World().airborne(20, 0, 5)
    world.power(0.29, LOW)
    world.obey(Mode.MODE_FLYING)
    world.power(0.14, CRITICAL)
    assert (world.asked[-1].id, world.asked[-1].action) == (1_000_001, Order.ACTION_LAND)
    world.obey(Mode.MODE_LANDING)
    world.power(0.29, LOW)
    world.pass_time(1)
    assert len(world.asked) == 2


def test_a_better_level_does_not_undo_a_decision() -> None:
    world = World().airborne(20, 0, 5)
    world.power(0.29, LOW)
    world.obey(Mode.MODE_FLYING)
    world.power(0.9)
    assert world.state[0] == SAFETY


def test_nothing_interrupts_a_landing() -> None:
    world = World().airborne(20, 0, 5)
    world.request(MISSION, command(Order.ACTION_LAND, 105))
    world.obey(Mode.MODE_LANDING)
    world.power(0.1, CRITICAL)
    world.fly(0.1, position=(200, 0, 5))
    assert [asked.id for asked in world.asked] == [105]


def test_the_fence_sends_the_vehicle_home() -> None:
    for position, inside in [
        ((101.9, 0, 5), True),
        ((0, -102.1, 5), False),
        ((0, 0, 31.9), True),
        ((0, 9, 32.1), False),
    ]:
        world = World().airborne(*position)
        world.pass_time(0.1)
        assert (world.state[0] == MISSION) == inside, position
    world = World().airborne(90, 0, 5)
    world.feed(LimitsSeen(limits(fence_radius=50)))
    assert world.state == (SAFETY, "outside of the fence, 90.0 m from home: returning home")


def test_without_a_position_the_fence_means_nothing() -> None:
    world = World().airborne(50, 0, 5)
    world.fly(0.1, position_valid=False, position=(500, 0, 5))
    assert world.state[0] == MISSION


def test_the_landing_of_a_return_waits_for_nothing() -> None:
    world = World().airborne(1, 0, 5)
    world.power(0.29, LOW)
    world.answer()
    # Home is reached before the flight home has taken effect.
    world.fly(0.05, position=(0.1, 0, 5))
    assert [asked.action for asked in world.asked] == [Order.ACTION_GO_TO, Order.ACTION_LAND]


def test_without_a_position_a_return_is_a_landing() -> None:
    world = World().airborne(20, 0, 5)
    world.fly(0.1, position_valid=False)
    world.power(0.29, LOW)
    assert (world.asked[0].id, world.asked[0].action) == (LANDING + 1_000_000, Order.ACTION_LAND)


def test_silent_power_management_is_low_power() -> None:
    world = World().airborne(20, 0, 5)
    world.pass_time(7)
    assert world.state[0] == MISSION
    world.pass_time(1)
    world.fly()
    assert world.state == (SAFETY, "no word from power management for 10 s: returning home")


def test_a_command_of_safety_is_repeated_until_it_is_in_effect() -> None:
    world = World().airborne(20, 0, 5)
    world.power(0.29, LOW)
    world.answer(None, "gone")
    world.answer(None, "gone")
    for _ in range(5):
        world.pass_time(0.2)
        world.answer(None, "gone")
    assert len(world.asked) == 6
    assert world.said[1:] == ["the autopilot does not answer; trying again"]
    world.fly(0.2)
    world.answer(CommandResult(accepted=False, reason="busy"))
    world.pass_time(0.2)
    assert world.said[2:] == ["the autopilot refuses to go to east 0.0, north 0.0, height 5.0 m: busy; trying again"]
    world.answer()
    # Accepted, but lost by a restart of the autopilot: after the time in which it should have taken effect it is sent again.
    asked = len(world.asked)
    world.fly(0.2)
    assert len(world.asked) == asked
    world.fly(0.3)
    assert len(world.asked) == asked + 1


def test_safety_overrules_a_command_that_the_autopilot_is_answering() -> None:
    world = World().airborne(20, 0, 5)
    number = world.request(MISSION, NORTH)
    world.power(0.29, LOW)
    assert [asked.id for asked in world.asked] == [101]
    world.answer()
    assert world.replies[number].reason == "safety commands the vehicle: low power, 29 % left: returning home"
    assert [asked.id for asked in world.asked] == [101, HOME + 1_000_000]
    assert world.state[0] == SAFETY


def test_an_autopilot_that_is_away_is_asked_for_a_second() -> None:
    world = World().airborne()
    number = world.request(MISSION, NORTH)
    began = world.now
    while number not in world.replies:
        world.answer(None, "it is not running")
        world.pass_time(0.1)
    assert world.replies[number].reason == "the autopilot does not answer: it is not running"
    assert world.now - began == pytest.approx(1.0, abs=0.2)
    asked = len(world.asked)
    world.pass_time(1)
    assert len(world.asked) == asked


def test_a_lost_reply_is_not_a_refusal() -> None:
    world = World()
    number = world.request(MISSION, command(Order.ACTION_TAKE_OFF, 100, 0, 0, 5))
    world.answer(None, "timeout")
    world.fly(0.2, mode=Mode.MODE_TAKING_OFF, command_id=100)
    assert world.replies[number] == ACCEPTED
    assert world.state[0] == MISSION


def test_a_request_waits_for_the_first_word_of_the_autopilot() -> None:
    world = World(heard=False)
    world.power(1.0)
    number = world.request(MISSION, command(Order.ACTION_TAKE_OFF, 100, 0, 0, 5))
    world.pass_time(0.5)
    assert world.asked == []
    world.fly()
    world.answer()
    assert world.replies[number] == ACCEPTED
    silent = World(heard=False)
    number = silent.request(MISSION, command(Order.ACTION_TAKE_OFF, 100, 0, 0, 5))
    silent.pass_time(1.1)
    assert silent.replies[number].reason == "nothing was received from the autopilot"


def test_a_silent_autopilot_is_reported_once() -> None:
    world = World().airborne()
    world.pass_time(3)
    assert world.said == ["no word from the autopilot for 1 s"]
    assert world.state == (MISSION, "the autopilot is silent (take off to 5.0 m)")
    world.fly()
    assert world.said[1:] == ["the autopilot sends again after 3.0 s"]
    assert world.state == (MISSION, "take off to 5.0 m")


def test_landing_on_the_ground_is_done_already() -> None:
    world = World()
    number = world.request(MISSION, command(Order.ACTION_LAND, 105))
    assert (world.replies[number], world.asked) == (ACCEPTED, [])


def test_a_return_on_request_lands_in_the_name_of_the_requester() -> None:
    world = World().airborne(20, 0, 5)
    number = world.request(GROUND, command(Order.ACTION_RETURN, 10_007))
    world.obey(Mode.MODE_FLYING)
    assert world.replies[number] == ACCEPTED
    assert world.state == (GROUND, "return")
    world.fly(5.0, position=(0, 0.1, 5))
    world.obey(Mode.MODE_LANDING)
    assert [asked.id for asked in world.asked] == [HOME + 10_007, LANDING + 10_007]
    # The ground station may change its mind.
    world = World().airborne(20, 0, 5)
    world.request(GROUND, command(Order.ACTION_RETURN, 10_007))
    world.obey(Mode.MODE_FLYING)
    world.request(GROUND, command(Order.ACTION_GO_TO, 10_008, 0, 0, 5))
    world.obey(Mode.MODE_FLYING)
    world.fly(5.0, position=(0, 0, 5))
    assert len(world.asked) == 2


def test_a_restarted_arbiter_goes_on() -> None:
    cases = [
        (100, (MISSION, "as before a restart of the arbiter"), []),
        (10_000, (GROUND, "as before a restart of the arbiter"), []),
        (HOME + 1_000_003, (SAFETY, "continuing after a restart of the arbiter"), [LANDING + 1_000_003]),
        (HOME + 10_003, (GROUND, "continuing after a restart of the arbiter"), [LANDING + 10_003]),
        (LANDING + 10_003, (GROUND, "continuing after a restart of the arbiter"), []),
        (1_000_003, (SAFETY, "continuing after a restart of the arbiter"), []),
        (0, (NOBODY, ""), []),
    ]
    for command_id, state, asked in cases:
        world = World(heard=False)
        world.fly(mode=Mode.MODE_FLYING, command_id=command_id, position=(20, 0, 6))
        world.fly(5.0, position=(0, 0, 6))
        assert world.state == state
        assert [it.id for it in world.asked] == asked, command_id


def test_a_restarted_arbiter_decides_again_about_low_power() -> None:
    world = World(heard=False)
    world.fly(mode=Mode.MODE_FLYING, command_id=103, position=(20, 0, 6))
    world.power(0.29, LOW)
    assert [asked.id for asked in world.asked] == [HOME + 1_000_000]
    # In the middle of the return it keeps to the height of the first decision.
    world = World(heard=False)
    world.flight.target.z = 8.0
    world.fly(mode=Mode.MODE_FLYING, command_id=HOME + 1_000_000, position=(20, 0, 6))
    world.power(0.29, LOW)
    assert world.asked == []
    assert world.state[0] == SAFETY


def test_on_the_ground_safety_decides_nothing() -> None:
    world = World()
    world.power(0.05, CRITICAL)
    world.pass_time(20)
    assert (world.asked, world.state) == ([], (NOBODY, "the autopilot is silent ()"))


def test_there_is_no_take_off_with_a_charge_of_long_ago() -> None:
    world = World()
    world.pass_time(10.1)
    number = world.request(MISSION, command(Order.ACTION_TAKE_OFF, 100, 0, 0, 5))
    expected = "the battery's charge is unknown; there is no word from power management"
    assert world.replies[number].reason == expected


def test_a_simulator_that_starts_again_does_not_keep_the_old_authority() -> None:
    world = World().airborne()
    world.request(MISSION, NORTH)
    world.answer()
    world.now -= 100
    world.fly(mode=Mode.MODE_GROUNDED, command_id=0)
    assert world.state == (NOBODY, "on the ground")
    world.feed(Tick())
