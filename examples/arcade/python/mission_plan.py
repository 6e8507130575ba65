"""Makes commands of a mission's steps, and checks before take-off whether they are allowed and the battery lasts."""

import math
from dataclasses import dataclass

from arcade_scl import Action, Command, Limits, Power, Vector
from battery import IDLE_CURRENT
from mission_script import GoTo, Hold, Land, Mission, Return, Step, TakeOff

FIRST_ID = 100  # the id of the command of step 1; that of step 2 is one more: a restarted mission knows its step by it
SETTLING = 3.0  # s that each step takes to accelerate, to brake and to be sure that it is reached
MARGIN = 1.3  # the battery has to last this much longer than the mission is estimated to take: wind costs time


@dataclass(frozen=True)
class Leg:
    """A step with its command and where it leads."""

    number: int  # counted from 1
    step: Step
    airborne: bool  # whether the vehicle is in the air before it
    command: Command | None  # None: nothing to command, as when holding on the ground
    start: tuple[float, float, float]  # east, north, height in m
    end: tuple[float, float, float]

    @property
    def id(self) -> int:
        return FIRST_ID + self.number - 1

    def __str__(self) -> str:
        east, north, height = self.end
        match self.step.task:
            case TakeOff():
                return f"take off to {height:g} m"
            case GoTo():
                return f"go to east {east:g}, north {north:g}, height {height:g} m"
            case Hold(seconds):
                return f"hold for {seconds:g} s"
            case Return():
                return f"return home at {height:g} m"
            case Land():
                return "land"


def plan(mission: Mission) -> list[Leg]:
    """The legs of a mission that starts on the ground at home."""
    legs: list[Leg] = []
    start, airborne, yaw = (0.0, 0.0, 0.0), False, 0.0
    for number, step in enumerate(mission.steps, start=1):
        action, end, speed = Action.ACTION_GO_TO, start, 0.0
        match step.task:
            case TakeOff(height):
                action, end = Action.ACTION_TAKE_OFF, (start[0], start[1], height)
            case GoTo(east, north, height):
                end, speed = (east, north, height), step.task.speed or 0.0
                yaw = yaw if step.task.yaw is None else math.radians(step.task.yaw)
            case Return():
                # Not ACTION_RETURN, with which the arbiter also lands: a mission may go on from home.
                end = (0.0, 0.0, start[2])
            case Land():
                action, end = Action.ACTION_LAND, (start[0], start[1], 0.0)
        command = None
        if airborne or isinstance(step.task, TakeOff):
            # A hold commands the point where the vehicle is, so that its id tells a restarted mission the step.
            target = Vector(x=end[0], y=end[1], z=end[2])
            command = Command(id=FIRST_ID + number - 1, action=action, target=target, yaw=yaw, speed=speed)
        legs.append(Leg(number, step, airborne, command, start, end))
        start, airborne = end, end[2] > 0
    return legs


def outside(legs: list[Leg], limits: Limits, file: str) -> list[str]:
    """The waypoints that the fence does not allow, with numbers."""
    problems = []
    for leg in legs:
        if not isinstance(leg.step.task, TakeOff | GoTo):
            continue  # leads to no new point
        where = f"{file}:{leg.step.line}: step {leg.number}"
        distance = math.hypot(leg.end[0], leg.end[1])
        if distance > limits.fence_radius:
            problems.append(
                f"{where}: {distance:.1f} m from home is outside of the fence (`fence_radius` is {limits.fence_radius:g} m)"
            )
        if leg.end[2] > limits.fence_height:
            problems.append(
                f"{where}: a height of {leg.end[2]:g} m is above the fence (`fence_height` is {limits.fence_height:g} m)"
            )
    return problems


def duration(legs: list[Leg], limits: Limits) -> float:
    """How many seconds the mission takes in still air."""
    return sum(leg_duration(leg, limits) for leg in legs)


def leg_duration(leg: Leg, limits: Limits) -> float:
    if isinstance(leg.step.task, Hold):
        return leg.step.task.seconds
    speed = min((leg.command.speed if leg.command else 0.0) or math.inf, limits.speed)
    across = math.dist(leg.start[:2], leg.end[:2]) / speed
    upwards = abs(leg.end[2] - leg.start[2]) / limits.climb
    return max(across, upwards) + SETTLING


def time_in_air(power: Power, hover_current: float) -> float:
    """How many seconds the battery lasts in the air. On the ground nearly no current flows, so the one of hovering counts."""
    current = max(power.current, IDLE_CURRENT)
    return power.time_left * current / max(current, hover_current)


def too_long(legs: list[Leg], limits: Limits, power: Power, hover_current: float) -> list[str]:
    """Says so if the battery is too small."""
    needed, lasts = duration(legs, limits) * MARGIN, time_in_air(power, hover_current)
    if needed <= lasts:
        return []
    seconds = f"the mission takes about {needed / MARGIN:.0f} s, {needed:.0f} s with a margin of {MARGIN - 1:.0%}"
    return [f"the battery is too small: {seconds}, and it lasts {lasts:.0f} s; charge it or shorten the mission"]
