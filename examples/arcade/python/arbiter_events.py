"""What the arbiter's logic takes and gives: events in, actions out."""

from dataclasses import dataclass

from arcade_scl import Authority, Command, CommandResult, Flight, Limits, Power


@dataclass(frozen=True)
class FlightSeen:
    flight: Flight


@dataclass(frozen=True)
class PowerSeen:
    power: Power


@dataclass(frozen=True)
class LimitsSeen:
    limits: Limits


@dataclass(frozen=True)
class Requested:
    """The mission or the ground station wants a command."""

    source: Authority
    number: int  # of the request, to be repeated in its `Reply`
    command: Command


@dataclass(frozen=True)
class Answered:
    """The autopilot has answered the last `Ask`, or has not."""

    result: CommandResult | None
    problem: str = ""  # why there is no result


@dataclass(frozen=True)
class Tick:
    """Time has passed."""


Event = FlightSeen | PowerSeen | LimitsSeen | Requested | Answered | Tick


@dataclass(frozen=True)
class Ask:
    """Send a command to the autopilot. There is no other one before it is `Answered`."""

    command: Command
    timeout: float  # s


@dataclass(frozen=True)
class Reply:
    """Answer a request."""

    number: int
    result: CommandResult


@dataclass(frozen=True)
class Say:
    """Something happened: print it and give it to the black box."""

    text: str


Action = Ask | Reply | Say
