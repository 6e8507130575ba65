"""A course: what the arbiter makes of a return or a landing. It is sent again until the autopilot does it."""

import math
from dataclasses import dataclass

import command_ids
from arcade_scl import Action, Authority, Command, Flight, Mode, Vector

NEAR_HOME = 0.5  # m, seen from above: there a return becomes a landing


@dataclass(frozen=True)
class Course:
    authority: Authority  # who wanted it
    id: int  # of the request, or of safety's decision
    phase: int  # `command_ids.HOME`, then `LANDING`; 0 is a landing that is no part of a return
    height: float  # m, of the flight home
    reason: str

    def next(self, flight: Flight) -> "Course":
        """The course as it is for this state of the vehicle."""
        # Without a position there is no way home.
        if self.phase == command_ids.HOME and (is_near_home(flight) or not flight.position_valid):
            return Course(self.authority, self.id, command_ids.LANDING, self.height, self.reason)
        return self

    def command(self, flight: Flight) -> Command:
        """The command of the present phase."""
        command_id = self.id + self.phase
        if self.phase != command_ids.HOME:
            return Command(id=command_id, action=Action.ACTION_LAND)
        home = Vector(x=0, y=0, z=self.height)
        return Command(id=command_id, action=Action.ACTION_GO_TO, target=home, yaw=flight.target_yaw)


def is_near_home(flight: Flight) -> bool:
    return flight.position_valid and math.hypot(flight.position.x, flight.position.y) < NEAR_HOME


def return_height(flight: Flight, lowest: float, highest: float) -> float:
    """The present height, but not lower than is safe above obstacles and not above the fence."""
    return min(max(flight.position.z, lowest), highest)


def resumed(flight: Flight) -> Course | None:
    """What an arbiter that has just started has to go on with, by the command in effect."""
    if flight.mode == Mode.MODE_GROUNDED:
        return None
    authority, asked, phase = command_ids.split(flight.command_id)
    if phase or authority == Authority.AUTHORITY_SAFETY:
        return Course(authority, asked, phase, flight.target.z, "continuing after a restart of the arbiter")
    return None
