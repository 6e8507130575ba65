"""The parameters of all components: names, defaults, ranges and units in one table, and the checks that follow from it."""

import difflib
import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from arcade_scl import Parameters


@dataclass(frozen=True)
class Spec:
    """What is known of one parameter."""

    name: str
    default: float
    lowest: float
    highest: float
    unit: str
    description: str


TABLE = (
    Spec("rate.roll_pitch.p", 0.06, 0.001, 1, "1/(rad/s)", "set-point difference for an error of roll or pitch rate"),
    Spec("rate.roll_pitch.i", 0.1, 0, 5, "1/rad", "the same for its integral"),
    Spec("rate.roll_pitch.d", 0.001, 0, 0.1, "1/(rad/s^2)", "the same for its derivative"),
    Spec("rate.yaw.p", 0.15, 0.001, 5, "1/(rad/s)", "set-point difference for an error of the yaw rate"),
    Spec("rate.yaw.i", 0.1, 0, 5, "1/rad", "the same for its integral"),
    Spec("attitude.p", 6, 0.5, 20, "1/s", "roll and pitch rate for an attitude error"),
    Spec("attitude.yaw.p", 2, 0.1, 10, "1/s", "yaw rate for a heading error"),
    Spec("velocity.p", 2.5, 0.1, 10, "1/s", "horizontal acceleration for a velocity error"),
    Spec("velocity.i", 0.8, 0, 5, "1/s^2", "the same for its integral"),
    Spec("climb.p", 4, 0.1, 20, "1/s", "vertical acceleration for an error of the climb rate"),
    Spec("climb.i", 2, 0, 10, "1/s^2", "the same for its integral"),
    Spec("position.p", 1, 0.1, 5, "1/s", "horizontal velocity for a position error"),
    Spec("height.p", 1.5, 0.1, 5, "1/s", "climb rate for a height error"),
    Spec("estimation.attitude.p", 2, 0, 20, "1/s", "correction of the attitude by the unit's own angles"),
    Spec("estimation.attitude.i", 0.2, 0, 5, "1/s^2", "correction of the gyroscope's bias by the same"),
    Spec("estimation.position.p", 0.5, 0, 10, "1/s", "correction of the horizontal position by fixes"),
    Spec("estimation.velocity.p", 0.8, 0, 10, "1/s", "correction of the horizontal velocity by fixes"),
    Spec("estimation.velocity.i", 0.1, 0, 5, "1/s^2", "correction of the accelerometer's bias by fixes"),
    Spec("estimation.height.bandwidth", 2.5, 0.1, 20, "1/s", "how fast the height follows the height sensors"),
    Spec("estimation.barometer.p", 0.3, 0, 10, "1/s", "correction of the barometer's drift by the ultrasonic sensor"),
    Spec("thrust.hover", 0.45, 0.1, 0.9, "1", "mean motor set-point that carries the weight"),
    Spec("thrust.minimum", 0.1, 0, 0.5, "1", "lowest motor set-point in the air"),
    Spec("thrust.maximum", 0.9, 0.5, 1, "1", "highest motor set-point"),
    Spec("limit.tilt", 25, 5, 45, "degrees", "largest roll and pitch"),
    Spec("limit.speed", 4, 0.2, 15, "m/s", "horizontal speed of a command that gives none"),
    Spec("limit.climb", 1.5, 0.2, 5, "m/s", "climb and descent"),
    Spec("limit.acceleration", 1.5, 0.2, 5, "m/s^2", "change of the commanded velocity"),
    Spec("limit.yaw_rate", 60, 5, 360, "degrees/s", "turning to another heading"),
    Spec("land.speed", 0.5, 0.1, 1.5, "m/s", "descent in the last metres"),
    Spec("fence.radius", 100, 5, 1000, "m", "greatest distance from home, seen from above"),
    Spec("fence.height", 30, 2, 120, "m", "greatest height above home"),
    Spec("fence.margin", 2, 0.5, 20, "m", "how far beyond the fence the vehicle is sent home"),
    Spec("return.height", 3, 1, 30, "m", "a return does not fly lower than this"),
    Spec("gps.rate", 5, 1, 20, "1/s", "fixes of the GPS receiver"),
    Spec("power.low", 0.3, 0.05, 0.9, "1", "charge at which the vehicle returns home"),
    Spec("power.critical", 0.15, 0.02, 0.5, "1", "charge at which it lands where it is"),
    Spec("power.hysteresis", 0.05, 0, 0.2, "1", "rise above these that ends the level"),
    Spec("power.cells", 3, 1, 12, "cells", "lithium-polymer cells in series"),
    Spec("power.resistance", 0.02, 0, 0.5, "ohm", "internal resistance of the battery"),
    Spec("power.hover_current", 12, 0.1, 200, "A", "current in the air, for estimates before take-off"),
    Spec("home.latitude", 50.6866, -89, 89, "degrees", "latitude of home, north positive"),
    Spec("home.longitude", 10.919, -180, 180, "degrees", "longitude of home, east positive"),
    Spec("home.altitude", 480, -400, 6000, "m", "altitude of home above mean sea level"),
)
BY_NAME: Mapping[str, Spec] = MappingProxyType({spec.name: spec for spec in TABLE})
DEFAULTS: Mapping[str, float] = MappingProxyType({spec.name: spec.default for spec in TABLE})


def mistake(name: str, value: float) -> str | None:
    """What is wrong with setting `name` to `value`; `None` if it may be set."""
    spec = BY_NAME.get(name)
    if spec is None:
        similar = difflib.get_close_matches(name, BY_NAME, n=1)
        return f"unknown parameter `{name}`" + (f"; did you mean `{similar[0]}`?" if similar else "")
    if spec.lowest <= value <= spec.highest:
        return None
    problem = "is out of range" if math.isfinite(value) else "is not a finite number"
    return f"`{name}: {value:g}` {problem}; it is {range_of(spec)}"


def range_of(spec: Spec) -> str:
    """The range with its unit, as people write it."""
    unit = "" if spec.unit == "1" else f" {spec.unit}"
    return f"{spec.lowest:g} to {spec.highest:g}{unit}"


def values_of(message: Parameters) -> Mapping[str, float]:
    """The values of a received message. A parameter that is missing or out of range has its default."""
    received = {parameter.name: parameter.value for parameter in message.parameters}
    return {name: value for name, default in DEFAULTS.items() for value in [_usable(name, received.get(name, default))]}


def _usable(name: str, value: float) -> float:
    return DEFAULTS[name] if mistake(name, value) else value
