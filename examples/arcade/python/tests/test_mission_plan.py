"""Commands of steps, and what is refused before take-off."""

import math
from pathlib import Path

from arcade_scl import Action, Power
from defaults import hover_current, limits
from mission_plan import Leg, duration, outside, plan, time_in_air, too_long
from mission_script import parse, read

SURVEY = Path(__file__).parents[2] / "missions" / "survey.yaml"
LIMITS, HOVER_CURRENT = limits(), hover_current()


def legs_of(*steps: str) -> list[Leg]:
    return plan(parse("name: x\nsteps:\n" + "".join(f"- {step}\n" for step in steps), "m.yaml"))


def test_each_step_has_an_id_and_a_command() -> None:
    legs = legs_of(
        "take_off: {height: 5}", "go_to: {east: 3, north: 4, height: 6, yaw: 90}", "hold: 1s", "return: {}", "land: {}"
    )
    commands = [leg.command for leg in legs if leg.command]
    assert [command.id for command in commands] == [100, 101, 102, 103, 104] == [leg.id for leg in legs]
    go_to = Action.ACTION_GO_TO
    assert [command.action for command in commands] == [
        Action.ACTION_TAKE_OFF, go_to, go_to, go_to, Action.ACTION_LAND
    ]  # fmt: skip
    assert [leg.end for leg in legs] == [(0, 0, 5), (3, 4, 6), (3, 4, 6), (0, 0, 6), (0, 0, 0)]
    # Without a heading of its own, a step keeps the one before.
    assert [command.yaw for command in commands] == [0] + 4 * [math.pi / 2]


def test_holding_on_the_ground_commands_nothing() -> None:
    assert [leg.command for leg in legs_of("hold: 1s")] == [None]


def test_the_survey_is_within_the_limits_and_takes_about_a_minute() -> None:
    legs = plan(read(SURVEY))
    assert outside(legs, LIMITS, "survey.yaml") == []
    assert 45 < duration(legs, LIMITS) < 75


def test_waypoints_beyond_the_fence_are_refused_with_numbers() -> None:
    legs = legs_of("take_off: {height: 5}", "go_to: {east: 60, north: -80.5, height: 31}", "land: {}")
    assert outside(legs, LIMITS, "m.yaml") == [
        "m.yaml:4: step 2: 100.4 m from home is outside of the fence (`fence_radius` is 100 m)",
        "m.yaml:4: step 2: a height of 31 m is above the fence (`fence_height` is 30 m)",
    ]


def test_a_take_off_above_the_fence_is_refused() -> None:
    assert outside(legs_of("take_off: {height: 40}", "land: {}"), LIMITS, "m.yaml") == [
        "m.yaml:3: step 1: a height of 40 m is above the fence (`fence_height` is 30 m)"
    ]


def test_the_duration_follows_from_the_slowest_speed() -> None:
    there = legs_of("take_off: {height: 5}", "go_to: {east: 40, north: 0, height: 5}", "land: {}")
    slowly = legs_of("take_off: {height: 5}", "go_to: {east: 40, north: 0, height: 5, speed: 2}", "land: {}")
    too_fast = legs_of("take_off: {height: 5}", "go_to: {east: 40, north: 0, height: 5, speed: 9}", "land: {}")
    assert duration(slowly, LIMITS) - duration(there, LIMITS) == 10
    assert duration(too_fast, LIMITS) == duration(there, LIMITS)


def test_on_the_ground_the_current_of_hovering_counts() -> None:
    # A full battery of 2.2 Ah lasts for two days at 0.05 A, and for 11 minutes at 12 A.
    idle = Power(current=0.01, time_left=2.2 * 3600 / 0.05)
    assert time_in_air(idle, HOVER_CURRENT) == 660
    assert time_in_air(Power(current=20, time_left=300), HOVER_CURRENT) == 300
    assert time_in_air(Power(), HOVER_CURRENT) == 0


def test_a_battery_that_is_too_small_is_refused_with_numbers() -> None:
    legs = legs_of("take_off: {height: 5}", "hold: 92s", "land: {}")
    fast = limits(climb=5)
    assert duration(legs, fast) == 100
    assert too_long(legs, fast, Power(current=12, time_left=130), HOVER_CURRENT) == []
    seconds = "the mission takes about 100 s, 130 s with a margin of 30%, and it lasts 129 s"
    refused = f"the battery is too small: {seconds}; charge it or shorten the mission"
    assert too_long(legs, fast, Power(current=12, time_left=129), HOVER_CURRENT) == [refused]
