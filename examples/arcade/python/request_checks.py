"""Why a request cannot be passed on to the autopilot: who asks, what for, and what the vehicle is doing."""

import math

import command_ids
from arcade_scl import Action, Authority, Command, Flight, Limits, Mode, Power, PowerLevel

ACTIONS = {
    Action.ACTION_TAKE_OFF: "take off",
    Action.ACTION_GO_TO: "go to",
    Action.ACTION_LAND: "land",
    Action.ACTION_RETURN: "return",
}
SOURCES = {
    Authority.AUTHORITY_MISSION: "the mission",
    Authority.AUTHORITY_GROUND: "the ground station",
    Authority.AUTHORITY_SAFETY: "safety",
}


def describe(command: Command) -> str:
    """A command in words, with its target where it has one."""
    target = command.target
    match command.action:
        case Action.ACTION_TAKE_OFF:
            return f"take off to {target.z:.1f} m"
        case Action.ACTION_GO_TO:
            return f"go to east {target.x:.1f}, north {target.y:.1f}, height {target.z:.1f} m"
        case other:
            return ACTIONS.get(other, f"action {other}")


def refusal(source: Authority, command: Command, flight: Flight, power: Power | None, limits: Limits) -> str | None:
    """Returns the reason if a command cannot be passed on."""
    ids = command_ids.RANGES[source]
    if command.id not in ids:
        return f"command id {command.id} is not one of {SOURCES[source]}; those are {ids.start} to {ids.stop - 1}"
    if command.action not in ACTIONS:
        return f"unknown action {command.action}; known are {', '.join(ACTIONS.values())}"
    return (
        _bad_number(command)
        or _wrong_moment(command, flight)
        or _beyond_fence(command, limits)
        or _cannot_take_off(command, power)
    )


def _bad_number(command: Command) -> str | None:
    if command.action in (Action.ACTION_TAKE_OFF, Action.ACTION_GO_TO) and not command.HasField("target"):
        return f"`{ACTIONS[command.action]}` without a target"
    target = command.target
    numbers = (("x", target.x), ("y", target.y), ("z", target.z), ("yaw", command.yaw), ("speed", command.speed))
    for name, value in numbers:
        if not math.isfinite(value):
            return f"{name} is {value}, which is not a finite number"
    return f"speed {command.speed:g} m/s is negative" if command.speed < 0 else None


def _wrong_moment(command: Command, flight: Flight) -> str | None:
    grounded = flight.mode == Mode.MODE_GROUNDED
    if command.action == Action.ACTION_TAKE_OFF:
        if not grounded:
            return "the vehicle is in the air already"
    elif grounded:
        return (
            None if command.action == Action.ACTION_LAND else "the vehicle is on the ground; it has to take off first"
        )
    if command.action != Action.ACTION_LAND and not flight.position_valid:
        return "the position is unknown; there is no recent GPS fix"
    return None


def _beyond_fence(command: Command, limits: Limits) -> str | None:
    if command.action not in (Action.ACTION_TAKE_OFF, Action.ACTION_GO_TO):
        return None
    height = limits.fence_height
    if not 0 < command.target.z <= height:
        return f"a height of {command.target.z:.1f} m is outside of the fence, which is 0 to {height:g} m high"
    # A take-off goes straight up from where the vehicle stands.
    distance = math.hypot(command.target.x, command.target.y)
    if command.action == Action.ACTION_GO_TO and distance > limits.fence_radius:
        return f"{distance:.1f} m from home is outside of the fence, which has a radius of {limits.fence_radius:g} m"
    return None


def _cannot_take_off(command: Command, power: Power | None) -> str | None:
    if command.action != Action.ACTION_TAKE_OFF:
        return None
    if power is None:
        return "the battery's charge is unknown; there is no word from power management"
    if power.level != PowerLevel.POWER_LEVEL_OK:
        return f"only {100 * power.charge_left:.0f} % of the battery is left"
    return None
