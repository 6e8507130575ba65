"""Decides what a mission does next: which step it is at, when that is reached, and who else commands the vehicle."""

import math
from dataclasses import dataclass, field

from arcade_scl import Arbitration, Authority, Command, CommandResult, Flight, Mode
from mission_plan import FIRST_ID, Leg
from mission_script import Hold, Land, TakeOff

NEAR = 0.4  # m: a waypoint is reached when the estimate is that close ...
NEAR_FOR = 1_000_000  # us: ... for that long, so that flying past it is not enough
REPEAT = 2_000_000  # us after which a command that has no effect, or was refused, is sent again


@dataclass
class Decision:
    """What to do now."""

    lines: list[str] = field(default_factory=list)  # to be printed
    command: Command | None = None  # to be sent
    exit_code: int | None = None  # set at the end of the mission


@dataclass
class Progress:
    """Follows a mission by the messages of the autopilot. All times are those of the vehicle's clock."""

    legs: list[Leg]
    index: int | None = None  # of the leg; None before the first message
    began_us: int | None = None  # when the leg's command took effect
    near_since_us: int | None = None
    repeat_us: int = 0  # when the command is sent (again)
    interruption: str = ""  # why another component commands the vehicle
    refusal: str = ""

    def update(self, flight: Flight, arbitration: Arbitration | None) -> Decision:
        """Takes what the autopilot says, and decides."""
        decision = Decision()
        others = command_of_others(arbitration)
        if self.index is None and not self.find_step(flight, others, decision):
            return decision
        leg = self.legs[self.index or 0]
        landed = flight.mode == Mode.MODE_GROUNDED
        if landed and leg.airborne and not (isinstance(leg.step.task, Land) and flight.command_id == leg.id):
            # Those who landed the vehicle may have handed it over since.
            why = because(others or self.interruption)
            decision.lines.append(f"stopped at step {leg.number}: the vehicle is on the ground{why}")
            decision.exit_code = 1
            return decision
        if others != self.interruption:
            decision.lines.append(f"waiting: {others}" if others else "continuing")
            self.interruption = others
            self.repeat_us = flight.time_us  # the command of the step has lost its effect
        if not others:
            self.pursue(leg, flight, decision)
        return decision

    def answered(self, result: CommandResult, now_us: int) -> Decision:
        """Takes the arbiter's answer to the command. A reason is told once, however often the command is repeated."""
        self.repeat_us = now_us + REPEAT
        news = not result.accepted and result.reason != self.refusal
        self.refusal = "" if result.accepted else result.reason
        return Decision([f"refused: {result.reason}; trying again"] if news else [])

    def find_step(self, flight: Flight, others: str, decision: Decision) -> bool:
        """Begins with the step whose command is in effect, or with the first one."""
        index = flight.command_id - FIRST_ID
        grounded = flight.mode == Mode.MODE_GROUNDED
        if 0 <= index < len(self.legs):
            self.index = index
            self.repeat_us = flight.time_us + REPEAT  # the command is in effect already
            decision.lines.append(f"resuming at {self.title()}")
        elif flight.command_id == 0 and grounded:
            self.enter(0, decision)
        elif grounded or not others:
            # Nobody but this mission may start the flight, so a vehicle that others have landed stays on the ground.
            where = "on the ground" if grounded else "in the air"
            decision.lines.append(
                f"the vehicle is {where} after command {flight.command_id}, which is not a step of this mission"
                f"{because(others)}; land it and restart the autopilot to fly a mission"
            )
            decision.exit_code = 1
        return self.index is not None

    def pursue(self, leg: Leg, flight: Flight, decision: Decision) -> None:
        """Goes on with a step: sends its command, or the next one when it is reached."""
        if leg.command is not None and flight.command_id != leg.id:
            self.began_us = None
            if flight.time_us >= self.repeat_us:
                decision.command = leg.command
            return
        if self.began_us is None:
            self.began_us = flight.time_us
        if not self.is_reached(leg, flight, self.began_us):
            return
        if leg.number < len(self.legs):
            self.enter(leg.number, decision)
            self.pursue(self.legs[leg.number], flight, decision)
        else:
            distance = math.hypot(flight.position.x, flight.position.y)
            flown = isinstance(leg.step.task, Land)
            decision.lines.append(f"mission complete, {distance:.2f} m from home" if flown else "mission complete")
            decision.exit_code = 0

    def enter(self, index: int, decision: Decision) -> None:
        self.index, self.began_us, self.near_since_us, self.repeat_us = index, None, None, 0
        decision.lines.append(self.title())

    def is_reached(self, leg: Leg, flight: Flight, began_us: int) -> bool:
        match leg.step.task:
            case Hold(seconds):
                return flight.time_us - began_us >= seconds * 1e6
            case Land():
                return flight.mode == Mode.MODE_GROUNDED
            case TakeOff():
                near = abs(flight.position.z - leg.end[2]) < NEAR
            case _:
                position = (flight.position.x, flight.position.y, flight.position.z)
                near = flight.position_valid and math.dist(position, leg.end) < NEAR
        if not near or flight.mode == Mode.MODE_GROUNDED:
            self.near_since_us = None
            return False
        self.near_since_us = self.near_since_us or flight.time_us
        return flight.time_us - self.near_since_us >= NEAR_FOR

    def title(self) -> str:
        leg = self.legs[self.index or 0]
        return f"step {leg.number} of {len(self.legs)}: {leg}"


def command_of_others(arbitration: Arbitration | None) -> str:
    """Who commands the vehicle in place of the mission, and why; empty if nobody does."""
    if arbitration is None or arbitration.authority not in NAMES:
        return ""
    return f"{NAMES[arbitration.authority]} commands the vehicle{because(arbitration.reason)}"


NAMES = {Authority.AUTHORITY_SAFETY: "safety", Authority.AUTHORITY_GROUND: "the ground station"}


def because(reason: str) -> str:
    return f": {reason}" if reason else ""
