"""What the ground station sees and types: one line about the vehicle a second, and commands such as `return`."""

import difflib
import math
from dataclasses import dataclass, field
from typing import Generic, TypeVar

import command_ids
from arcade_scl import Arbitration, Authority, Fix, FixQuality, Flight, Mode, Power, PowerLevel

T = TypeVar("T")
STALE = 2.0  # s after which a message is shown as missing: an old position looks like a vehicle that stands still

MODES = {
    Mode.MODE_GROUNDED: "grounded",
    Mode.MODE_TAKING_OFF: "taking off",
    Mode.MODE_FLYING: "flying",
    Mode.MODE_LANDING: "landing",
}
AUTHORITIES = {
    Authority.AUTHORITY_NOBODY: "nobody",
    Authority.AUTHORITY_MISSION: "mission",
    Authority.AUTHORITY_GROUND: "ground",
    Authority.AUTHORITY_SAFETY: "safety",
}
LEVELS = {PowerLevel.POWER_LEVEL_LOW: " low", PowerLevel.POWER_LEVEL_CRITICAL: " critical"}


@dataclass
class Newest(Generic[T]):
    """The newest message of a gate, while it is fresh. Times are seconds of any steady clock."""

    message: T | None = None
    arrived: float = 0.0

    def keep(self, message: T | None, now: float) -> None:
        if message is not None:
            self.message, self.arrived = message, now

    def fresh(self, now: float) -> T | None:
        return self.message if now - self.arrived < STALE else None


@dataclass
class Vehicle:
    """What is known of the vehicle."""

    flight: Newest[Flight] = field(default_factory=Newest)
    fix: Newest[Fix] = field(default_factory=Newest)
    power: Newest[Power] = field(default_factory=Newest)
    arbitration: Newest[Arbitration] = field(default_factory=Newest)

    def line(self, now: float) -> str:
        """The line of this second. A part that is silent is shown as `-`."""
        flight, fix = self.flight.fresh(now), self.fix.fresh(now)
        power, arbitration = self.power.fresh(now), self.arbitration.fresh(now)
        if flight is None:
            state = "time -, mode -, east -, north -, height -"
        else:
            p = flight.position
            where = f"east {p.x:z.1f}, north {p.y:z.1f}" if flight.position_valid else "east -, north -"
            mode = MODES.get(flight.mode, "-")
            state = f"time {flight.time_us / 1e6:.1f} s, mode {mode}, {where}, height {p.z:z.1f} m"
        charge = f"{power.charge_left:.0%}{LEVELS.get(power.level, '')}" if power else "-"
        command = AUTHORITIES.get(arbitration.authority, "-") if arbitration else "-"
        if arbitration and arbitration.authority == Authority.AUTHORITY_SAFETY:
            command += f" ({arbitration.reason})"
        satellites = "-" if fix is None else f"{fix.satellites}"
        if fix is not None and fix.quality == FixQuality.FIX_QUALITY_NONE:
            satellites += " (no fix)"
        return f"{state}, battery {charge}, commanded by {command}, satellites {satellites}"


@dataclass(frozen=True)
class GoHome:
    """`return`: fly home and land."""


@dataclass(frozen=True)
class LandHere:
    """`land`: land here."""


@dataclass(frozen=True)
class SetParameter:
    """`set NAME VALUE`."""

    name: str
    value: float


Order = GoHome | LandHere | SetParameter
USAGE = "commands are `return`, `land` and `set NAME VALUE`"


def understand(text: str) -> Order | str:
    """What the ground station wants, or what is wrong with it."""
    match text.split():
        case ["return"]:
            return GoHome()
        case ["land"]:
            return LandHere()
        case ["set", name, value]:
            try:
                number = float(value)
            except ValueError:
                number = math.nan
            return SetParameter(name, number) if math.isfinite(number) else f"`{value}` is not a number"
        case ["return" | "land" | "set" as command, *_]:
            return f"wrong arguments of `{command}`; {USAGE}"
        case [command, *_]:
            close = difflib.get_close_matches(command, ["return", "land", "set"], n=1)
            hint = f"; did you mean `{close[0]}`?" if close else f"; {USAGE}"
            return f"unknown command {command!r}{hint}".replace("'", "`")
        case _:
            return USAGE


def next_id(in_effect: int) -> int:
    """An id that differs from that of the command in effect, also after a restart of this program."""
    authority, asked, _ = command_ids.split(in_effect)
    ids = command_ids.RANGES[Authority.AUTHORITY_GROUND]
    return asked + 1 if authority == Authority.AUTHORITY_GROUND and asked + 1 in ids else ids.start
