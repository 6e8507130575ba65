"""The safety rules: what the arbiter decides by itself while the vehicle is in the air."""

import math
from dataclasses import dataclass

from arcade_scl import Flight, Limits, Mode, Power, PowerLevel

POWER_SILENCE = 10.0  # s without `power`: a restart of power management takes less


@dataclass(frozen=True)
class Danger:
    reason: str
    land_here: bool  # otherwise: return, then land


def danger(
    flight: Flight, power: Power | None, power_silence: float, limits: Limits | None, fence_margin: float
) -> Danger | None:
    """The most urgent reason not to go on; `power_silence` is the time since the last `power`, in seconds."""
    # A vehicle that is landing does what is safest, also for a reason that comes up meanwhile.
    if flight.mode in (Mode.MODE_GROUNDED, Mode.MODE_LANDING):
        return None
    if power and power.level == PowerLevel.POWER_LEVEL_CRITICAL:
        return Danger(f"critical power, {_left(power)}: landing here", land_here=True)
    if power and power.level == PowerLevel.POWER_LEVEL_LOW:
        return Danger(f"low power, {_left(power)}: returning home", land_here=False)
    if limits and (reason := beyond_fence(flight, limits, fence_margin)):
        return Danger(f"{reason}: returning home", land_here=False)
    if power_silence > POWER_SILENCE:
        return Danger(f"no word from power management for {POWER_SILENCE:g} s: returning home", land_here=False)
    return None


def beyond_fence(flight: Flight, limits: Limits, margin: float) -> str | None:
    """Where the vehicle is, if that is farther outside than the margin. Without a position it is nowhere."""
    if not flight.position_valid:
        return None
    distance, height = math.hypot(flight.position.x, flight.position.y), flight.position.z
    if distance > limits.fence_radius + margin:
        return f"outside of the fence, {distance:.1f} m from home"
    if height > limits.fence_height + margin:
        return f"above the fence, at {height:.1f} m"
    return None


def _left(power: Power) -> str:
    return f"{100 * power.charge_left:.0f} % left"
